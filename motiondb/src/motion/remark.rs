//! What is said of a clip, and how much of it a user need read.
//!
//! A remark is a kind and a sentence. What it weighs follows from its kind, never from its words. Programs read the
//! sentence alone (JSON's `warnings[]`), a database holds both.

use std::fmt;

use serde::{Deserialize, Serialize, Serializer};

/// One remark.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Remark {
    /// What it is about.
    pub kind: Kind,
    /// For people, without the clip's name.
    pub text: String,
}

/// What a remark is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Why the clip gives no example.
    NoExample,

    /// A gait too fast or too slow for any human: the frame time lies, and with it all speeds.
    FrameTime,
    /// A body of no human's size: if the unit lies, so do all speeds.
    Size,
    /// Names that take left for right.
    Sides,
    /// Something else than feet on level ground moves the body.
    Ground,
    /// Planted feet that slide, or are hardly planted.
    Feet,
    /// A header that claims what the file does not hold.
    Header,
    /// A T-pose that could not be cut off.
    TPose,
    /// The same take as another clip, at another frame time: one of both is wrong.
    OtherTime,
    /// It was not compared with all other clips.
    Uncompared,

    /// What is no part of the motion was cut off.
    Cut,
    /// Gait noise in its parameters was taken as 0.
    Snapped,
    /// Parts of it, or an example, that say no more than others, or less well.
    LeftOut,
    /// The same take as another clip.
    SameTake,
    /// Another example with its parameters is blended in its place.
    Twin,
}

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// The clip is used as it is meant to be: nothing to do.
    Note,
    /// The clip is used, but something about it is doubtful.
    Warning,
    /// The clip gives no example.
    NoExample,
}

impl Kind {
    /// How much a remark of this kind matters.
    pub fn weight(self) -> Weight {
        match self {
            Self::NoExample => Weight::NoExample,
            Self::FrameTime
            | Self::Size
            | Self::Sides
            | Self::Ground
            | Self::Feet
            | Self::Header
            | Self::TPose
            | Self::OtherTime
            | Self::Uncompared => Weight::Warning,
            Self::Cut | Self::Snapped | Self::LeftOut | Self::SameTake | Self::Twin => Weight::Note,
        }
    }

    /// A remark of this kind.
    pub fn remark(self, text: impl Into<String>) -> Remark {
        Remark { kind: self, text: text.into() }
    }
}

impl Remark {
    /// How much it matters.
    pub fn weight(&self) -> Weight {
        self.kind.weight()
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = if self.kind == Kind::NoExample { "no example: " } else { "" };
        write!(out, "{head}{}", self.text)
    }
}

impl Serialize for Remark {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            serializer.collect_str(self)
        } else {
            (self.kind, &self.text).serialize(serializer)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_read_the_sentence_and_a_database_the_kind_too() {
        let remark = Kind::NoExample.remark("its feet slide");
        assert_eq!(serde_json::to_string(&remark).unwrap(), "\"no example: its feet slide\"");
        let bytes = bincode::serde::encode_to_vec(&remark, bincode::config::standard()).unwrap();
        let (read, _) = bincode::serde::decode_from_slice::<Remark, _>(&bytes, bincode::config::standard()).unwrap();
        assert_eq!(read, remark);
    }
}

//! What was found in a clip that a user should know: a code with arguments, a severity, and a sentence for people.
//!
//! A diagnostic is a value: a database stores its variant and its arguments. A sentence states what is wrong, where, and
//! how to mend it. It does not name the clip: reports print that before it.

mod note;
mod unfit;
mod warning;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use note::Note;
pub use unfit::Unfit;
pub use warning::Warning;

/// One diagnostic, by severity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Diagnostic {
    /// The clip is used as intended.
    Note(Note),
    /// The clip is used, but something about it is doubtful.
    Warning(Warning),
    /// The clip gives no example.
    NoExample(Unfit),
}

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Nothing to do.
    Note,
    /// Something is doubtful.
    Warning,
    /// The clip gives no example.
    NoExample,
}

/// An end of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClipEnd {
    /// Its first frames.
    First,
    /// Its last frames.
    Last,
}

impl Diagnostic {
    /// The stable name of what was found, for programs; unique within a severity. It is the variant's name in serde too.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Note(note) => note.code(),
            Self::Warning(warning) => warning.code(),
            Self::NoExample(unfit) => unfit.code(),
        }
    }

    /// How much it matters.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Note(_) => Severity::Note,
            Self::Warning(_) => Severity::Warning,
            Self::NoExample(_) => Severity::NoExample,
        }
    }

    /// The same of a further example of the clip, which begins at this second of the file.
    #[must_use]
    pub fn of_example_from(mut self, start_s: f32) -> Self {
        if let Self::Note(Note::TurnRateSnapped { from_s, .. } | Note::StrafeSnapped { from_s, .. })
        | Self::Warning(Warning::FeetSlide { from_s, .. } | Warning::FeetHardlyPlanted { from_s, .. }) = &mut self
        {
            *from_s = Some(start_s);
        }
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Note(note) => note.fmt(out),
            Self::Warning(warning) => warning.fmt(out),
            Self::NoExample(unfit) => unfit.fmt(out),
        }
    }
}

/// ` in the example from 12.3 s on`; nothing for a clip's first example, which has the clip's name.
fn of_example(from_s: Option<f32>) -> String {
    from_s.map(|from_s| format!(" in the example from {from_s:.1} s on")).unwrap_or_default()
}

/// `1 steady window`, `2 steady windows`.
fn steady_windows(count: u32) -> String {
    format!("{count} steady window{}", if count == 1 { "" } else { "s" })
}

/// ` (2 steady windows are left out)`; nothing where none is.
fn and_left_out(count: u32) -> String {
    match count {
        0 => String::new(),
        1 => " (1 steady window is left out)".to_owned(),
        _ => format!(" ({} are left out)", steady_windows(count)),
    }
}

/// `, mirrored`, or nothing.
fn and_mirrored(mirrored: bool) -> &'static str {
    if mirrored { ", mirrored" } else { "" }
}

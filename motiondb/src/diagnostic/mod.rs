//! Diagnostics: what the compiler reports about a clip. Each has a code with arguments, a severity, and a sentence for
//! people.
//!
//! A diagnostic is a value: a database stores its variant and arguments. The sentence states the fault, its position
//! and the remedy. It does not name the clip: reports print the name before it.
//!
//! Read `note`, `warning` (with `warning_sentences`) and `unfit`, the diagnostics of each severity, with their arguments
//! `posture` and `held_part`.

mod held_part;
mod note;
mod posture;
pub mod unfit;
mod warning;
mod warning_sentences;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use held_part::HeldPart;
pub use note::Note;
pub use posture::Posture;
pub use unfit::Unfit;
pub use warning::Warning;

/// A diagnostic, by severity. Databases store variants by number, so a new one is the last of its severity.
///
/// ```
/// use motiondb::Side;
/// use motiondb::diagnostic::{Diagnostic, Severity, Unfit};
///
/// let diagnostic = Diagnostic::NoExample(Unfit::NoMidStance { foot: Side::Left });
/// assert_eq!(diagnostic.severity(), Severity::NoExample);
/// assert_eq!(diagnostic.code(), "no_mid_stance"); // for programs
/// println!("walk.bvh: {diagnostic}"); // for people
/// ```
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

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The clip is used as intended; nothing is to be done.
    Note,
    /// The clip is used, but something about it is doubtful.
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
    /// Stable name of the diagnostic, for programs; unique within a severity. It is also the variant's name in serde.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Note(note) => note.code(),
            Self::Warning(warning) => warning.code(),
            Self::NoExample(unfit) => unfit.code(),
        }
    }

    /// Severity of the diagnostic.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Note(_) => Severity::Note,
            Self::Warning(_) => Severity::Warning,
            Self::NoExample(_) => Severity::NoExample,
        }
    }

    /// Adds the start time of the example, for diagnostics that concern one example; others are unchanged.
    #[must_use]
    pub fn with_example_start_s(mut self, start_s: f32) -> Self {
        if let Self::Note(Note::TurnRateSnapped { from_s, .. } | Note::StrafeSnapped { from_s, .. })
        | Self::Warning(
            Warning::FeetSlide { from_s, .. }
            | Warning::FeetHardlyPlanted { from_s, .. }
            | Warning::LeansAside { from_s, .. }
            | Warning::TrunkBent { from_s, .. }
            | Warning::TrunkTwisted { from_s, .. }
            | Warning::CarriageUnlike { from_s, .. },
        ) = &mut self
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

/// ` in the example from 12.3 s on`; empty for a clip's first example, which has the clip's name.
fn of_example(from_s: Option<f32>) -> String {
    from_s.map(|from_s| format!(" in the example from {from_s:.1} s on")).unwrap_or_default()
}

/// `1 steady window`, `2 steady windows`.
fn steady_windows(count: u32) -> String {
    format!("{count} steady window{}", if count == 1 { "" } else { "s" })
}

/// ` (2 steady windows are left out)`; empty for none.
fn and_left_out(count: u32) -> String {
    match count {
        0 => String::new(),
        1 => " (1 steady window is left out)".to_owned(),
        _ => format!(" ({} are left out)", steady_windows(count)),
    }
}

/// `, mirrored`, or empty.
fn and_mirrored(mirrored: bool) -> &'static str {
    if mirrored { ", mirrored" } else { "" }
}

//! Rejection clips: what every command that reads clips prints of them, and what it answers.

use motiondb_compiler::{Outside, Rejection};

use crate::terminal::failure::Answer;
use crate::terminal::output;

/// Lists the refused clips on standard error.
pub(crate) fn say(refused: &[Rejection]) {
    for clip in refused {
        output::say(&format!("refused: {clip}"));
    }
}

/// The option `--allow-outside`.
pub(crate) fn outside(is_allowed: bool) -> Outside {
    if is_allowed { Outside::Allowed } else { Outside::Refused }
}

/// Yes where every clip was used.
pub(crate) fn answer(refused: &[Rejection]) -> Answer {
    Answer::of(refused.is_empty())
}

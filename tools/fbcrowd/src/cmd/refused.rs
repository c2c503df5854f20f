//! Rejection clips: what every command that reads clips prints of them, and what it answers.

use motiondb_compiler::Rejection;

use crate::terminal::failure::Answer;
use crate::terminal::output;

/// Lists the refused clips on standard error.
pub(crate) fn say(refused: &[Rejection]) {
    for clip in refused {
        output::say(&format!("refused: {clip}"));
    }
}

/// Yes where every clip was used.
pub(crate) fn answer(refused: &[Rejection]) -> Answer {
    Answer::of(refused.is_empty())
}

//! Rejected clips: how commands list them on standard error, and the exit code that they cause.

use motiondb_compiler::Rejection;

use crate::terminal::failure::Answer;
use crate::terminal::output;

/// Lists the rejected files and clips on standard error.
pub(crate) fn print(rejected: &[Rejection]) {
    for rejection in rejected {
        output::say(&format!("rejected: {rejection}"));
    }
}

/// Yes if every clip was used.
pub(crate) fn answer(rejected: &[Rejection]) -> Answer {
    Answer::of(rejected.is_empty())
}

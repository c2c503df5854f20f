//! Rejected clips: how commands list them on standard error, and the exit code that they cause.

use motiondb_compiler::{Outside, Rejection};

use crate::terminal::failure::Answer;
use crate::terminal::output;

/// Lists the rejected files and clips on standard error.
pub(crate) fn print(rejected: &[Rejection]) {
    for rejection in rejected {
        output::say(&format!("rejected: {rejection}"));
    }
}

/// The value of the option `--allow-outside`.
pub(crate) fn outside(is_allowed: bool) -> Outside {
    if is_allowed { Outside::Allowed } else { Outside::Refused }
}

/// Yes if every clip was used.
pub(crate) fn answer(rejected: &[Rejection]) -> Answer {
    Answer::of(rejected.is_empty())
}

//! Rejected clips: how commands list them on standard error, and the exit code that they cause.

use std::path::PathBuf;

use fbcrowd_jobs::clip_paths::passed_over;
use motiondb_compiler::Rejection;

use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Lists the rejected files and clips on standard error.
pub(crate) fn print(rejected: &[Rejection]) {
    for rejection in rejected {
        output::say(&format!("rejected: {rejection}"));
    }
}

/// Lists the files of other formats that lie beside the clips of folders. They do not change the exit code.
pub(crate) fn print_passed_over(paths: &[PathBuf]) -> Result<(), Failure> {
    passed_over(paths)?.iter().for_each(|line| output::say(line));
    Ok(())
}

/// Yes if every clip was used.
pub(crate) fn answer(rejected: &[Rejection]) -> Answer {
    Answer::of(rejected.is_empty())
}

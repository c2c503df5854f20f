//! What a command answers, and how bad usage and bad input end it.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use crate::output;

/// The answer of a command that could do its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Exit code 0.
    Yes,
    /// Exit code 1: an invariant is broken, or some input was refused while the rest was used.
    No,
}

/// Why a command could not do its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Exit code 2, with the message.
    Bad(miette::Report),
    /// Whoever read standard output has gone: nobody is left to tell.
    ReaderGone,
}

impl Failure {
    /// Bad usage or input; the message names what, where and the remedy.
    pub(crate) fn bad(message: impl Into<String>) -> Self {
        Self::Bad(miette::Report::msg(message.into()))
    }

    /// A file or folder that the system would not let us write.
    pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Self {
        Self::bad(format!("cannot write {}: {error}; choose another place", path.display()))
    }

    /// Says it on standard error.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::Bad(report) => {
                output::say(&format!("Error: {report:?}"));
                ExitCode::from(2)
            }
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }
}

impl From<motiondb::file::FileError> for Failure {
    fn from(error: motiondb::file::FileError) -> Self {
        Self::bad(error.to_string())
    }
}

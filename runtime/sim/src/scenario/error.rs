//! Errors of a scenario file: each names the position in the text, what is wrong there and how to mend it.

use std::io;
use std::path::PathBuf;

pub use motiondb::files::Invalid;

/// Why a scenario cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The system cannot read a file.
    #[error("{}: cannot be read: {source}; check that the file exists and is text in UTF-8", path.display())]
    Unreadable {
        /// The scenario file, or an agent file that it names.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The text describes something that cannot be simulated.
    #[error(transparent)]
    Invalid(Box<Invalid>),
}

impl From<Invalid> for ScenarioError {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(Box::new(invalid))
    }
}

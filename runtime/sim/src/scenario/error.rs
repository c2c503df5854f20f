//! What can be wrong with a scenario file: the place in its text, what is wrong there and what to do.

use std::io;
use std::path::PathBuf;

pub use motiondb::files::Invalid;

/// Why there is no scenario.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The system refuses to read.
    #[error("{}: cannot be read: {source}; check that the file exists and is text in UTF-8", path.display())]
    Unreadable {
        /// The scenario file, or one that it names.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The text says something that cannot be simulated.
    #[error(transparent)]
    Invalid(Box<Invalid>),
}

impl From<Invalid> for ScenarioError {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(Box::new(invalid))
    }
}

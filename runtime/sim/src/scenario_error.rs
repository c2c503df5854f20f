//! What can be wrong with a scenario file: the place in its text, what is wrong there and what to do.

use std::io;
use std::ops::Range;
use std::path::PathBuf;

/// Why there is no scenario.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The system refuses to read.
    #[error("{}: cannot be read: {source}; check that the file exists and is text", path.display())]
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

/// A mistake in a text, with all that is needed to show it there.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}:{}: {message}; {help}", path.display(), self.line())]
pub struct Invalid {
    /// The scenario file, or the agent file that it names.
    pub path: PathBuf,
    /// Its whole text.
    pub text: String,
    /// The bytes of the text that are wrong.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl Invalid {
    /// Line of the mistake, counted from 1.
    pub fn line(&self) -> usize {
        let before = &self.text.as_bytes()[..self.span.start.min(self.text.len())];
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }
}

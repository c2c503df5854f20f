//! Input that gives no clip: which, and why.

use std::fmt;

/// A file that cannot be read as motion, or a clip of it that is no human's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// The file, as it was named.
    pub file: String,
    /// Clip within the file; empty for the file as a whole.
    pub clip: String,
    /// What is wrong, where, and what to do.
    pub reason: String,
}

impl fmt::Display for Refused {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        match self.clip.as_str() {
            "" => write!(to, "{}: {}", self.file, self.reason),
            clip => write!(to, "{}, {clip}: {}", self.file, self.reason),
        }
    }
}

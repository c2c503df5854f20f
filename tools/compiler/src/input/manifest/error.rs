//! What can be wrong with a manifest, and what to do.

use std::io;
use std::path::PathBuf;

use motiondb::files::Invalid;

use crate::error::ImportError;

/// Why a manifest cannot be followed.
#[derive(Debug, thiserror::Error)]
pub enum ManifestError {
    /// The system refuses to read it.
    #[error("{}: cannot be read: {source}; check that the file exists and is text in UTF-8", path.display())]
    Unreadable {
        /// The manifest.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A folder that it names cannot be read.
    #[error(transparent)]
    Folder(#[from] ImportError),
    /// It says something that is not so.
    #[error(transparent)]
    Invalid(Box<Invalid>),
}

impl From<Invalid> for ManifestError {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(Box::new(invalid))
    }
}

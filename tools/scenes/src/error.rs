//! Why a scene cannot be converted.

use std::io;
use std::path::{Path, PathBuf};

use motiondb::files::{Invalid, SourceText, input_file};

/// Why a scene cannot be converted.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A mistake in a file of the scene, at its line.
    #[error(transparent)]
    Mistake(Box<Invalid>),
    /// A file cannot be read, or is not text.
    #[error("{} cannot be read: {source}; name a scene as text in UTF-8", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The scene exceeds a limit of scenario files.
    #[error("{}: {what}; simplify the scene, or convert a part of it", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What is too large, and the limit.
        what: String,
    },
    /// The name of the file states no format.
    #[error(
        "{}: its name states no format; name a file that ends in .xml (Menge), .wkt, .geojson, .json, .dxf or .scenario",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
}

impl SceneError {
    /// Whether the machine failed (disk, memory), so that a retry may help.
    pub fn is_of_machine(&self) -> bool {
        matches!(self, Self::Unreadable { source, .. } if input_file::is_of_machine(source))
    }
}

impl From<Invalid> for SceneError {
    fn from(invalid: Invalid) -> Self {
        Self::Mistake(Box::new(invalid))
    }
}

/// Reads a text; the error names the file.
pub(crate) fn read_text(path: &Path) -> Result<SourceText, SceneError> {
    SourceText::read(path).map_err(|source| SceneError::Unreadable { path: path.to_owned(), source })
}

//! glTF → [`SourceClip`]s. In progress.

use std::path::Path;

use crate::error::ImportError;
use crate::source_clip::SourceClip;

/// Reads every animation of a glTF or GLB file.
///
/// # Errors
/// [`ImportError::Gltf`].
pub fn read(file: &Path, _bytes: &[u8]) -> Result<Vec<SourceClip>, ImportError> {
    Err(ImportError::UnknownFormat { file: file.to_owned() })
}

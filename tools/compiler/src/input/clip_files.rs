//! Clips on disk: which files are clips, by their names, and which further files they link to.

use std::fs;
use std::path::{Path, PathBuf};

use motiondb::files::input_file;

use crate::error::CompileError;
use crate::read::foreign_format::ForeignFormat;
use crate::read::gltf::{buffers, chunks, document_json};

/// A format of clips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClipFormat {
    /// Biovision hierarchy: `.bvh`.
    Bvh,
    /// glTF 2.0: `.glb`, `.gltf`.
    Gltf,
}

impl ClipFormat {
    /// The format that the extension of `path` names, in any case of letters.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "bvh" => Some(Self::Bvh),
            "glb" | "gltf" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// Paths of all `*.bvh`, `*.glb` and `*.gltf` below a folder, sorted.
///
/// Files and folders whose names begin with a dot are left out: macOS packs `._walk.bvh` beside each `walk.bvh`.
///
/// # Errors
/// [`CompileError::UnreadableFolder`].
pub fn clip_files(folder: &Path) -> Result<Vec<PathBuf>, CompileError> {
    files_below(folder, &|path| ClipFormat::of(path).is_some())
}

/// Paths of all files below a folder whose names are those of another format of motion, with the format; sorted.
///
/// # Errors
/// [`CompileError::UnreadableFolder`].
pub fn foreign_files(folder: &Path) -> Result<Vec<(PathBuf, ForeignFormat)>, CompileError> {
    let files = files_below(folder, &|path| ForeignFormat::of_name(path).is_some())?;
    let with_format = |file: PathBuf| ForeignFormat::of_name(&file).map(|format| (file, format));
    Ok(files.into_iter().filter_map(with_format).collect())
}

/// Paths of the wanted files below a folder, sorted.
fn files_below(folder: &Path, is_wanted: &dyn Fn(&Path) -> bool) -> Result<Vec<PathBuf>, CompileError> {
    let unreadable = |source| CompileError::UnreadableFolder { folder: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        if entry.file_name().as_encoded_bytes().starts_with(b".") {
            continue;
        }
        // `file_type` does not follow links: a link to a folder may lead back here.
        if entry.file_type().map_err(unreadable)?.is_dir() {
            files.extend(files_below(&entry.path(), is_wanted)?);
        } else if is_wanted(&entry.path()) {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// Paths of the buffers and pictures beside a glTF file that its URIs name: inputs that no output may replace.
///
/// Empty for other formats and for a file that cannot be read.
pub fn linked_files(path: &Path) -> Vec<PathBuf> {
    if ClipFormat::of(path) != Some(ClipFormat::Gltf) {
        return Vec::new();
    }
    let Ok(mut file) = input_file::open(path) else { return Vec::new() };
    let uris = chunks::read(&mut file).map(|chunks| document_json::uris(&chunks.json)).unwrap_or_default();
    buffers::linked_paths(path, &uris)
}

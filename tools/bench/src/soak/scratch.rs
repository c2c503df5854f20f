//! A temporary folder for files that are read by their path.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::JobError;

use crate::error::BenchError;
use crate::soak::draw::Draw;

/// A temporary folder of this process, removed when it is dropped.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    /// Creates the folder.
    pub(crate) fn new() -> Result<Self, BenchError> {
        let folder = std::env::temp_dir().join(format!("fbcrowd_soak_{}", std::process::id()));
        fs::create_dir_all(&folder).map_err(|error| JobError::unwritable(&folder, error))?;
        Ok(Self(folder))
    }

    /// The folder.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file in the folder; returns its path.
    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, BenchError> {
        let path = self.0.join(name);
        fs::write(&path, bytes).map_err(|error| JobError::unwritable(&path, error))?;
        Ok(path)
    }

    /// The result of `read` for a file with these bytes. Copies of several threads have different names.
    pub(crate) fn with<T>(&self, draw: &mut Draw, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
        let name = format!("copy_{:x}_{:x}", draw.below(usize::MAX), rayon::current_thread_index().unwrap_or(0));
        let path = self.write(&name, bytes).unwrap_or_else(|_| self.0.join(name));
        let result = read(&path);
        let _ = fs::remove_file(&path);
        result
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

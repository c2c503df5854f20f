//! A folder for what is read by its path, gone when the soak ends.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cmd::bench::soak::Draw;
use crate::failure::Failure;

/// A temporary folder of this process.
pub(super) struct Scratch(PathBuf);

impl Scratch {
    pub(super) fn new() -> Result<Self, Failure> {
        let folder = std::env::temp_dir().join(format!("fbcrowd_soak_{}", std::process::id()));
        fs::create_dir_all(&folder).map_err(|error| Failure::unwritable(&folder, &error))?;
        Ok(Self(folder))
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file of the folder.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Failure> {
        let path = self.0.join(name);
        fs::write(&path, bytes).map_err(|error| Failure::unwritable(&path, &error))?;
        Ok(path)
    }

    /// What `read` says of a copy that is on the disk meanwhile; copies of several threads have several names.
    pub(super) fn with<T>(&self, draw: &mut Draw, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
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

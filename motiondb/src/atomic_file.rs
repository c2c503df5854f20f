//! Files that appear under their final name whole or not at all, though the process be killed at any time.
//!
//! Nothing is forced onto the disk: that would cost a frame as much as drawing it, and only a failing power supply
//! would tell.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Files begun by this process: two of one name must not share a temporary one.
static BEGUN: AtomicU32 = AtomicU32::new(0);

/// A file being written beside its final name; dropped without [`AtomicFile::commit`], it is removed.
#[derive(Debug)]
pub struct AtomicFile {
    writer: Option<BufWriter<File>>,
    temporary: PathBuf,
    target: PathBuf,
}

impl AtomicFile {
    /// Opens `.NAME.PID.N.tmp` beside `target`.
    ///
    /// # Errors
    /// Where the folder cannot be written, or `target` exists and is no file: a folder, or a device that renaming would
    /// replace.
    pub fn create(target: &Path) -> io::Result<Self> {
        let name =
            target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        if fs::metadata(target).is_ok_and(|found| !found.is_file()) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "what is there is no regular file"));
        }
        let (process, begun) = (std::process::id(), BEGUN.fetch_add(1, Ordering::Relaxed));
        let temporary = target.with_file_name(format!(".{}.{process}.{begun}.tmp", name.to_string_lossy()));
        let writer = Some(BufWriter::new(File::create(&temporary)?));
        Ok(Self { writer, temporary, target: target.to_owned() })
    }

    /// The buffered file.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("taken only by commit, which consumes self")
    }

    /// Flushes and renames to the final name.
    ///
    /// # Errors
    /// Where flushing or renaming fails; the temporary file is removed.
    pub fn commit(mut self) -> io::Result<()> {
        if let Some(writer) = self.writer.take() {
            writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        }
        fs::rename(&self.temporary, &self.target)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        // After a commit the temporary name is gone and this does nothing.
        let _ = fs::remove_file(&self.temporary);
    }
}

/// Writes all bytes under the final name or none.
///
/// # Errors
/// As [`AtomicFile`].
pub fn write(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(target)?;
    file.writer().write_all(bytes)?;
    file.commit()
}

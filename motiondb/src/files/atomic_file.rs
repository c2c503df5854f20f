//! Files that appear under their final name complete or not at all, even if the process is killed.
//!
//! Bytes go into a temporary file beside the target, which is then renamed. Data is not forced onto the disk: that
//! would take as long as drawing a frame, and protect only against power failure. A symbolic link stays: its target is
//! written.
//!
//! A killed process leaves its temporary file. Each is locked during writing, so [`sweep`] can remove the abandoned
//! ones.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Number of files that this process has begun: makes the names of temporary files unique.
static BEGUN: AtomicU32 = AtomicU32::new(0);

/// Greatest number of attempts to create a temporary file: another process may sweep it before it is locked.
const ATTEMPTS_MAX: usize = 8;

/// Greatest number of symbolic links that are followed, as on Linux: ends a circle of links.
const LINKS_MAX: usize = 40;

/// A file that is being written beside its final name. Dropped without [`AtomicFile::commit`], it is removed.
///
/// ```
/// use std::io::Write;
/// use motiondb::AtomicFile;
///
/// # fn main() -> std::io::Result<()> {
/// let path = std::env::temp_dir().join(format!("atomic_file_{}.txt", std::process::id()));
/// let mut file = AtomicFile::create(&path)?;
/// file.writer().write_all(b"complete")?;
/// assert!(!path.exists()); // nothing under the final name yet
/// file.commit()?;
/// assert_eq!(std::fs::read(&path)?, b"complete");
/// # std::fs::remove_file(&path)
/// # }
/// ```
#[derive(Debug)]
pub struct AtomicFile {
    /// Writer of the temporary file; `None` after the commit.
    writer: Option<BufWriter<File>>,
    /// Path of the temporary file.
    temporary: PathBuf,
    /// Final path.
    target: PathBuf,
}

impl AtomicFile {
    /// Opens `.NAME.PID.N.tmp` beside `target`.
    ///
    /// # Errors
    /// If the folder cannot be written, or `target` exists and is not a regular file: a folder, or a device that the
    /// renaming would replace.
    pub fn create(target: &Path) -> io::Result<Self> {
        let target = followed(target);
        let name =
            target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        if fs::metadata(&target).is_ok_and(|found| !found.is_file()) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path exists and is not a regular file"));
        }
        for _ in 0..ATTEMPTS_MAX {
            let (process, begun) = (std::process::id(), BEGUN.fetch_add(1, Ordering::Relaxed));
            let temporary = target.with_file_name(format!(".{}.{process}.{begun}.tmp", name.to_string_lossy()));
            let file = File::create(&temporary)?;
            // On a system without locks, `sweep` gets none either and removes nothing.
            let _ = file.lock();
            // Another process may have swept the file before it was locked. Locked, it stays.
            if temporary.exists() {
                return Ok(Self { writer: Some(BufWriter::new(file)), temporary, target });
            }
        }
        Err(io::Error::other("another process keeps removing the temporary file"))
    }

    /// The buffered file.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("taken only by commit, which consumes self")
    }

    /// Flushes the file and renames it to its final name.
    ///
    /// # Errors
    /// If flushing or renaming fails; the temporary file is removed.
    pub fn commit(mut self) -> io::Result<()> {
        let flushed = self.writer.take().map(BufWriter::into_inner).transpose();
        // The lock is held until the file is renamed.
        let _locked = flushed.map_err(io::IntoInnerError::into_error)?;
        fs::rename(&self.temporary, &self.target)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        // After a commit the temporary file no longer exists, and this does nothing.
        let _ = fs::remove_file(&self.temporary);
    }
}

/// Removes the temporary files of `target` that killed processes have left, but none that any process is writing. Reads
/// the whole folder: use it before long writing.
pub fn sweep(target: &Path) {
    let target = followed(target);
    let (Some(name), Some(folder)) = (target.file_name(), target.parent()) else { return };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let head = format!(".{}.", name.to_string_lossy());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let file = entry.file_name();
        let numbers = file.to_str().and_then(|file| file.strip_prefix(&head)?.strip_suffix(".tmp")?.split_once('.'));
        let is_temporary =
            numbers.is_some_and(|(process, begun)| [process, begun].iter().all(|n| n.parse::<u32>().is_ok()));
        let unlocked = || File::options().write(true).open(entry.path()).ok().filter(|file| file.try_lock().is_ok());
        if is_temporary && let Some(_locked) = unlocked() {
            // A file that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Target of a symbolic link, even if it does not exist yet; any other path unchanged.
fn followed(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..LINKS_MAX {
        let Ok(next) = fs::read_link(&target) else { break };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    target
}

/// Writes all bytes under the final name, or none.
///
/// # Errors
/// As [`AtomicFile::create`] and [`AtomicFile::commit`], or if writing fails.
pub fn write(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(target)?;
    file.writer().write_all(bytes)?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_target_is_written() {
        let folder = std::env::temp_dir().join(format!("fbcrowd_links_{}", std::process::id()));
        fs::create_dir_all(folder.join("disk")).unwrap();
        let [link, far] = ["link", "far"].map(|name| folder.join(name));
        std::os::unix::fs::symlink("far", &link).unwrap();
        std::os::unix::fs::symlink("disk/a.fbdb", &far).unwrap();
        for text in ["first", "second"] {
            write(&link, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(folder.join("disk/a.fbdb")).unwrap(), text);
            assert!(link.is_symlink() && far.is_symlink());
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn only_abandoned_temporary_files_are_swept() {
        let folder = std::env::temp_dir().join(format!("fbcrowd_sweep_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let target = folder.join("a.fbrec");
        let kept = ["a.fbrec", ".a.fbrec.1.tmp", ".a.fbrec.x.0.tmp", ".b.fbrec.1.0.tmp", ".a.fbrec.1.0.tmp.txt"];
        for name in kept.iter().chain(&[".a.fbrec.1.0.tmp", ".a.fbrec.4000000.12.tmp"]) {
            fs::write(folder.join(name), "half").unwrap();
        }
        let mut written = AtomicFile::create(&target).unwrap();
        sweep(&target);
        written.writer().write_all(b"whole").unwrap();
        written.commit().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"whole");
        let mut left: Vec<String> =
            fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        left.sort();
        let mut kept = kept.map(str::to_owned);
        kept.sort();
        assert_eq!(left, kept);
        fs::remove_dir_all(&folder).unwrap();
    }
}

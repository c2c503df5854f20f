//! Files that appear under their final name complete or not at all, even if the process is killed.
//!
//! Bytes go into a [temporary file](super::temporary_files) beside the target, which is then renamed:
//!
//! 1. [`AtomicFile::create`] refuses a target that is a folder, a device or read-only, so that long work ends early.
//! 2. [`AtomicFile::commit`] forces the bytes onto the disk, renames the file, and forces the folder onto the disk.
//!    [`set_sync`] omits this; then a power failure, but no end of the process, may leave an empty file.
//!
//! A symbolic link stays: its target is written. An existing file's permission mode stays. A hard link does not stay:
//! other names of the same file keep the earlier content, so no reader of them sees half a file.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use tempfile::TempPath;

use crate::files::temporary_files;

/// Greatest number of symbolic links that are followed, as on Linux: ends a circle of links.
const LINKS_MAX: usize = 40;

/// Whether a commit forces file and folder onto the disk.
static SYNC: AtomicBool = AtomicBool::new(true);

/// Whether every commit of this process forces file and folder onto the disk; it does by default.
pub fn set_sync(sync: bool) {
    SYNC.store(sync, Ordering::Relaxed);
}

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
    /// Path of the temporary file; `None` after the commit.
    temporary: Option<TempPath>,
    /// Final path.
    target: PathBuf,
}

impl AtomicFile {
    /// Opens a temporary file in the folder of `target`, and removes the abandoned ones there.
    ///
    /// # Errors
    /// If the folder cannot be written, or as [`check_replaceable`].
    pub fn create(target: &Path) -> io::Result<Self> {
        let target = followed(target);
        let existing = replaceable(&target)?;
        let (file, temporary) = temporary_files::begin(folder_of(&target))?;
        let created = Self { writer: Some(BufWriter::new(file)), temporary: Some(temporary), target };
        if let (Some(existing), Some(writer)) = (existing, &created.writer) {
            writer.get_ref().set_permissions(existing.permissions())?;
        }
        Ok(created)
    }

    /// The buffered file.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("taken only by commit, which consumes self")
    }

    /// Path of the temporary file, for a program that writes it.
    pub fn temporary_path(&self) -> &Path {
        self.temporary.as_ref().expect("taken only by commit, which consumes self")
    }

    /// The final path.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Flushes the file and renames it to its final name.
    ///
    /// # Errors
    /// If writing to the disk or renaming fails; the temporary file is removed.
    pub fn commit(mut self) -> io::Result<()> {
        let sync = SYNC.load(Ordering::Relaxed);
        let (temporary, _locked) = self.written(sync)?;
        temporary_files::publish(temporary, &self.target)?;
        if sync { sync_folder(folder_of(&self.target)) } else { Ok(()) }
    }

    /// As [`Self::commit`], of a file that can be made again: it is not forced onto the disk, and is no output.
    ///
    /// # Errors
    /// If writing or renaming fails; the temporary file is removed.
    pub fn commit_unsynced(mut self) -> io::Result<()> {
        let (temporary, _locked) = self.written(false)?;
        temporary_files::publish_uncounted(temporary, &self.target)
    }

    /// The temporary file, written whole. The file holds its lock until it is renamed.
    fn written(&mut self, sync: bool) -> io::Result<(TempPath, File)> {
        let writer = self.writer.take().expect("taken only by commit, which consumes self");
        let locked = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        if sync {
            locked.sync_all()?;
        }
        Ok((self.temporary.take().expect("taken only by commit, which consumes self"), locked))
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        if let Some(temporary) = self.temporary.take() {
            temporary_files::discard(temporary);
        }
    }
}

/// Checks that a file can appear under this path: nothing is there, or a regular file that may be written.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] if the path names no file, or a folder, a device, a circle of links or a read-only file
/// is there; the system's error if it does not allow writing the file that is there.
pub fn check_replaceable(target: &Path) -> io::Result<()> {
    replaceable(&followed(target)).map(drop)
}

/// Checks that new files can appear in a folder, which need not exist: its nearest parent that exists is a folder that
/// may be written.
///
/// # Errors
/// [`ErrorKind::NotADirectory`], or the system's error when a file is created there (it is removed again).
pub fn check_folder(folder: &Path) -> io::Result<()> {
    let mut nearest = folder;
    while !nearest.as_os_str().is_empty() && fs::symlink_metadata(nearest).is_err() {
        nearest = nearest.parent().unwrap_or(Path::new(""));
    }
    let nearest = if nearest.as_os_str().is_empty() { Path::new(".") } else { nearest };
    if !fs::metadata(nearest)?.is_dir() {
        return Err(io::Error::new(ErrorKind::NotADirectory, format!("{} is not a folder", nearest.display())));
    }
    let (_, temporary) = temporary_files::begin(nearest)?;
    temporary_files::discard(temporary);
    Ok(())
}

/// What is at a path whose links have been followed; `None` if nothing is.
fn replaceable(target: &Path) -> io::Result<Option<fs::Metadata>> {
    let invalid = |fault| Err(io::Error::new(ErrorKind::InvalidInput, fault));
    if target.file_name().is_none() {
        return invalid("the path names no file");
    }
    let found = match fs::symlink_metadata(target) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        found => found?,
    };
    match found.file_type() {
        kind if kind.is_symlink() => invalid("the path leads through a circle of links"),
        kind if !kind.is_file() => invalid("the path exists and is not a regular file"),
        _ if found.permissions().readonly() => invalid("the file exists and is read-only"),
        _ => {
            // The system knows whether this process may write it: owner, access lists, file system.
            File::options().write(true).open(target)?;
            Ok(Some(found))
        }
    }
}

/// The folder that holds a path.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Forces a folder's entries onto the disk, where the system can.
fn sync_folder(folder: &Path) -> io::Result<()> {
    // Not every system opens or synchronises folders.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::PermissionDenied) => Err(error),
        _ => Ok(()),
    }
}

/// Target of a symbolic link, even if it does not exist yet; any other path unchanged.
pub fn followed(path: &Path) -> PathBuf {
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

    #[test]
    fn two_writers_of_one_file_leave_a_whole_one() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.fbdb");
        let [mut one, mut other] = [&target, &target].map(|target| AtomicFile::create(target).unwrap());
        one.writer().write_all(b"the first, longer").unwrap();
        other.writer().write_all(b"the second").unwrap();
        one.commit().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"the first, longer");
        other.commit().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"the second");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }

    #[test]
    fn the_longest_name_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("n".repeat(255));
        write(&target, b"whole").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"whole");
        assert!(AtomicFile::create(&folder.path().join("n".repeat(256))).is_err());
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.fbdb");
        fs::write(&target, "precious").unwrap();
        let mut permissions = fs::metadata(&target).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&target, permissions).unwrap();
        assert!(write(&target, b"new").unwrap_err().to_string().contains("read-only"));
        assert_eq!(fs::read(&target).unwrap(), b"precious");
    }

    #[cfg(unix)]
    #[test]
    fn an_existing_file_keeps_its_permission_mode() {
        use std::os::unix::fs::PermissionsExt;

        let folder = tempfile::tempdir().unwrap();
        let (target, new) = (folder.path().join("a.fbdb"), folder.path().join("new"));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        fs::write(&target, "old").unwrap();
        let ordinary = mode(&target);
        for kept in [0o600, 0o666, 0o640] {
            fs::set_permissions(&target, fs::Permissions::from_mode(kept)).unwrap();
            write(&target, b"new").unwrap();
            assert_eq!(mode(&target), kept);
        }
        write(&new, b"new").unwrap();
        assert_eq!(mode(&new), ordinary);
    }

    #[test]
    fn another_hard_link_keeps_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let [target, other] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&target, "old").unwrap();
        fs::hard_link(&target, &other).unwrap();
        write(&target, b"new").unwrap();
        assert_eq!([&target, &other].map(|path| fs::read(path).unwrap()), [b"new", b"old"]);
    }

    #[test]
    fn a_folder_that_can_be_made_is_accepted() {
        let folder = tempfile::tempdir().unwrap();
        check_folder(&folder.path().join("new/folder")).unwrap();
        fs::write(folder.path().join("file"), "no folder").unwrap();
        assert_eq!(check_folder(&folder.path().join("file/new")).unwrap_err().kind(), ErrorKind::NotADirectory);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_target_is_written() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("disk")).unwrap();
        let [link, far, circle] = ["link", "far", "circle"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink("far", &link).unwrap();
        std::os::unix::fs::symlink("disk/a.fbdb", &far).unwrap();
        std::os::unix::fs::symlink("circle", &circle).unwrap();
        for text in ["first", "second"] {
            write(&link, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(folder.path().join("disk/a.fbdb")).unwrap(), text);
            assert!(link.is_symlink() && far.is_symlink());
        }
        assert!(write(&circle, b"nowhere").is_err() && circle.is_symlink());
    }
}

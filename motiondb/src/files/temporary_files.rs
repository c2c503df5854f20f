//! Temporary files that this process is writing: one list, so that a signal can remove them all.
//!
//! A temporary file is called `.fbcrowd-` + 12 random letters and digits + `.tmp`; the name of its target has no part
//! in it. It is created exclusively, so no link or file of that name is ever opened, and no two processes share one.
//!
//! A killed process leaves its temporary files. Each is locked during writing, so the next process that writes into the
//! folder can remove the abandoned ones.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, TempPath};

/// Beginning of the name of every temporary file.
const PREFIX: &str = ".fbcrowd-";
/// End of the name of every temporary file.
const SUFFIX: &str = ".tmp";
/// Number of random letters and digits in the name of a temporary file.
const RANDOM_LETTERS: usize = 12;
/// Greatest number of attempts to create a temporary file: another process may sweep it before it is locked.
const ATTEMPTS_MAX: usize = 8;
/// Greatest number of complete outputs whose paths are kept.
const NAMED_OUTPUTS_MAX: usize = 8;

/// Outputs that this process has completed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CompletedOutputs {
    /// Paths of the first of them, at most eight.
    pub first: Vec<PathBuf>,
    /// Number of all.
    pub count: usize,
}

/// What this process writes and has written.
struct WrittenFiles {
    /// Temporary files that are being written.
    open: BTreeSet<PathBuf>,
    /// Folders in which abandoned files have been removed.
    swept: BTreeSet<PathBuf>,
    completed: CompletedOutputs,
}

static WRITTEN: Mutex<WrittenFiles> = Mutex::new(WrittenFiles {
    open: BTreeSet::new(),
    swept: BTreeSet::new(),
    completed: CompletedOutputs { first: Vec::new(), count: 0 },
});

/// The list; a panic cannot leave it half-written.
fn written() -> MutexGuard<'static, WrittenFiles> {
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Creates and locks a temporary file in a folder. The first call for a folder removes the abandoned ones there.
///
/// # Errors
/// If the folder cannot be written.
pub(crate) fn begin(folder: &Path) -> io::Result<(File, TempPath)> {
    let mut written = written();
    if written.swept.insert(folder.canonicalize()?) {
        sweep(folder);
    }
    for _ in 0..ATTEMPTS_MAX {
        let (file, temporary) = builder().tempfile_in(folder)?.into_parts();
        // On a system without locks, `sweep` gets none either and removes nothing.
        let _ = file.lock();
        // Another process may have swept the file before it was locked. Locked, it stays.
        if temporary.exists() {
            written.open.insert(temporary.to_path_buf());
            return Ok((file, temporary));
        }
    }
    Err(io::Error::other("another process keeps removing the temporary file"))
}

/// A builder of temporary files with the permission mode of any new file.
fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM_LETTERS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

/// Renames a temporary file to its final path, and counts it among the completed outputs.
///
/// # Errors
/// If the system refuses; the temporary file is removed.
pub(crate) fn publish(temporary: TempPath, target: &Path) -> io::Result<()> {
    let mut written = written();
    written.rename(temporary, target)?;
    written.completed.count += 1;
    if written.completed.first.len() < NAMED_OUTPUTS_MAX {
        written.completed.first.push(target.to_owned());
    }
    Ok(())
}

/// As [`publish`], of a file that is no output.
///
/// # Errors
/// As [`publish`].
pub(crate) fn publish_uncounted(temporary: TempPath, target: &Path) -> io::Result<()> {
    written().rename(temporary, target)
}

impl WrittenFiles {
    fn rename(&mut self, temporary: TempPath, target: &Path) -> io::Result<()> {
        self.open.remove(&*temporary);
        temporary.persist(target).map_err(|error| error.error)
    }
}

/// Removes a temporary file.
pub(crate) fn discard(temporary: TempPath) {
    let mut written = written();
    written.open.remove(&*temporary);
    // A file that cannot be removed does no harm.
    let _ = temporary.close();
}

/// The outputs that this process has completed.
pub fn completed() -> CompletedOutputs {
    written().completed.clone()
}

/// Removes every temporary file of this process, and lets no thread begin or complete another: for a process that ends
/// at once. A thread that tries waits for ever.
pub fn abandon_all() {
    let written = written();
    for temporary in &written.open {
        let _ = fs::remove_file(temporary);
    }
    mem::forget(written);
}

/// Removes the temporary files that killed processes have left in a folder, but none that any process is writing.
pub(crate) fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        // The type of a link is not that of its target; to open a pipe would block.
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file
            && is_temporary(&entry.file_name())
            && let Some(_locked) = unlocked(&entry.path())
        {
            // A file that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A file that no process has locked, locked by this one.
fn unlocked(path: &Path) -> Option<File> {
    let mut options = File::options();
    options.write(true);
    // The entry may have become a link or a pipe since its type was read.
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NOFOLLOW | libc::O_NONBLOCK);
    options.open(path).ok().filter(|file| file.try_lock().is_ok())
}

fn is_temporary(name: &OsStr) -> bool {
    let random = name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
    random.is_some_and(|random| random.len() == RANDOM_LETTERS && random.bytes().all(|b| b.is_ascii_alphanumeric()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_abandoned_temporary_files_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let kept = ["a.fbrec", ".fbcrowd-short.tmp", ".fbcrowd-abcdefghijk-.tmp", ".fbcrowd-abcdefghijkl.tmp.txt"];
        for name in kept.iter().chain(&[".fbcrowd-abcdefghijkl.tmp", ".fbcrowd-0123456789AB.tmp"]) {
            fs::write(path(name), "half").unwrap();
        }
        let (file, open) = begin(folder.path()).unwrap();
        sweep(folder.path());
        assert!(open.exists());
        drop(file);
        discard(open);
        let mut left: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        let mut kept = kept.map(OsStr::new);
        kept.sort();
        assert_eq!(left, kept);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_pipes_are_not_swept() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("precious"), "all there is").unwrap();
        std::os::unix::fs::symlink("precious", path(".fbcrowd-abcdefghijkl.tmp")).unwrap();
        let pipe = path(".fbcrowd-abcdefghijkm.tmp");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        sweep(folder.path());
        assert!(pipe.exists() && path(".fbcrowd-abcdefghijkl.tmp").is_symlink());
        assert_eq!(fs::read_to_string(path("precious")).unwrap(), "all there is");
    }

    #[test]
    fn names_are_random_and_exclusive() {
        let folder = tempfile::tempdir().unwrap();
        let files: Vec<_> = (0..50).map(|_| begin(folder.path()).unwrap()).collect();
        let names: BTreeSet<_> = files.iter().map(|(_, path)| path.file_name().unwrap().to_owned()).collect();
        assert_eq!(names.len(), 50);
        assert!(names.iter().all(|name| is_temporary(name)));
        files.into_iter().for_each(|(_, path)| discard(path));
    }
}

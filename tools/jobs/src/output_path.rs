//! Checks of output paths before work begins: an output replaces no input, no other output, no folder and no read-only
//! file, and its folder may be written.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use motiondb::files::atomic_file::{self, AtomicFile, followed};

use crate::error::JobError;

/// Checks that an output path names none of the input files.
///
/// # Errors
/// [`JobError::OutputIsInput`].
pub fn check_is_no_input(output: &Path, inputs: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<(), JobError> {
    // A file that does not exist is not an input.
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let is_output = |input: &Path| input.canonicalize().is_ok_and(|input| input == existing);
    match inputs.into_iter().any(|input| is_output(input.as_ref())) {
        true => Err(JobError::OutputIsInput { output: output.to_owned() }),
        false => Ok(()),
    }
}

/// Whether two paths name one file, after all links are followed. The file need not exist.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    written_path(one) == written_path(other)
}

/// The path that an output replaces: its links are followed, and its folder is spelt in one manner.
fn written_path(output: &Path) -> PathBuf {
    let path = followed(output);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name))
}

/// Checks that a file can be written: its folder exists and may be written, and no folder, device or read-only file is
/// there. Leaves nothing.
///
/// # Errors
/// [`JobError::UnfitOutput`], or [`JobError::Unwritable`] where the system does not allow it.
pub fn check_file(output: &Path) -> Result<(), JobError> {
    AtomicFile::create(output).map(drop).map_err(|error| unfit(output, error))
}

/// Checks that files can be written into a folder, which need not exist, that none of them is an input, and that no two
/// are links to one file. Leaves nothing.
///
/// # Errors
/// As [`check_file`] and [`check_is_no_input`], or [`JobError::LinksToOneFile`].
pub fn check_files(folder: &Path, outputs: &[PathBuf], inputs: &[PathBuf]) -> Result<(), JobError> {
    atomic_file::check_folder(folder).map_err(|error| unfit(folder, error))?;
    outputs.iter().try_for_each(|output| check_file_of_folder(output, inputs))?;
    let mut written = BTreeMap::new();
    for output in outputs {
        if let Some(first) = written.insert(written_path(output), output) {
            return Err(JobError::LinksToOneFile { first: first.clone(), second: output.clone() });
        }
    }
    Ok(())
}

fn check_file_of_folder(output: &Path, inputs: &[PathBuf]) -> Result<(), JobError> {
    check_is_no_input(output, inputs)?;
    match atomic_file::check_replaceable(output) {
        // The folder is made later.
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        checked => checked.map_err(|error| unfit(output, error)),
    }
}

/// An output path is wrong, or the system does not allow to write there.
fn unfit(output: &Path, error: io::Error) -> JobError {
    match is_wrong_path(&error) {
        true => JobError::UnfitOutput { output: output.to_owned(), fault: error.to_string() },
        false => JobError::unwritable(output, error),
    }
}

/// Whether an I/O error means a wrong path, not a failure of the system.
pub(crate) fn is_wrong_path(error: &io::Error) -> bool {
    use ErrorKind::{AlreadyExists, InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound};

    // `create_dir_all` returns `AlreadyExists` where a file has the path of the folder.
    matches!(error.kind(), AlreadyExists | InvalidFilename | InvalidInput | IsADirectory | NotADirectory | NotFound)
}

/// A folder that no other `fbcrowd run` writes into while this value lives.
#[derive(Debug)]
pub struct LockedFolder {
    /// The folder, locked; `None` on a system without locks of folders.
    _lock: Option<File>,
}

impl LockedFolder {
    /// Makes a folder if it is missing, and locks it against every other process.
    ///
    /// # Errors
    /// [`JobError::FolderInUse`]; [`JobError::UnfitOutput`] or [`JobError::Unwritable`] where it cannot be made.
    pub fn exclusive(folder: &Path) -> Result<Self, JobError> {
        Self::locked(folder, File::try_lock)
    }

    /// As [`LockedFolder::exclusive`], but others that lock it in this manner may write too: each writes other files.
    ///
    /// # Errors
    /// As [`LockedFolder::exclusive`].
    pub fn shared(folder: &Path) -> Result<Self, JobError> {
        Self::locked(folder, File::try_lock_shared)
    }

    fn locked(folder: &Path, lock: fn(&File) -> Result<(), TryLockError>) -> Result<Self, JobError> {
        fs::create_dir_all(folder).map_err(|error| unfit(folder, error))?;
        // Not every system opens or locks folders.
        let Ok(opened) = File::open(folder) else { return Ok(Self { _lock: None }) };
        match lock(&opened) {
            Err(TryLockError::WouldBlock) => Err(JobError::FolderInUse { folder: folder.to_owned() }),
            _ => Ok(Self { _lock: Some(opened) }),
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn two_links_to_one_file_are_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other, file] = ["one", "other", "file"].map(|name| folder.path().join(name));
        for link in [&one, &other] {
            std::os::unix::fs::symlink("file", link).unwrap();
        }
        assert!(is_same_file(&one, &other) && is_same_file(&one, &file));
        fs::write(&file, "there").unwrap();
        assert!(is_same_file(&one, &other) && is_same_file(&one, &file));
        assert!(!is_same_file(&one, &folder.path().join("another")));
    }

    #[test]
    fn files_of_a_folder_are_no_links_to_one() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| folder.path().join(name));
        let outputs = [one.clone(), other.clone()];
        check_files(folder.path(), &outputs, &[]).unwrap();
        std::os::unix::fs::symlink("other", &one).unwrap();
        let refused = check_files(folder.path(), &outputs, &[]);
        assert!(matches!(refused, Err(JobError::LinksToOneFile { .. })), "{refused:?}");
        assert!(check_files(&folder.path().join("new/folder"), &[], &[]).is_ok());
    }

    #[test]
    fn a_folder_is_locked_for_one_or_shared() {
        let folder = tempfile::tempdir().unwrap();
        let alone = LockedFolder::exclusive(folder.path()).unwrap();
        assert!(matches!(LockedFolder::shared(folder.path()), Err(JobError::FolderInUse { .. })));
        drop(alone);
        let _shared = LockedFolder::shared(folder.path()).unwrap();
        LockedFolder::shared(folder.path()).unwrap();
        assert!(matches!(LockedFolder::exclusive(folder.path()), Err(JobError::FolderInUse { .. })));
    }
}

//! A kind of file in a [`container`]: what its messages call it, how it is compiled again, and how much of it is read;
//! and the errors of all kinds.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::files::container::{self, ContainerError, HEADER_LENGTH};
use crate::files::{atomic_file, input_file};

/// A kind of file.
#[derive(Debug, PartialEq, Eq)]
pub struct FileKind {
    /// Magic number with which a file begins.
    pub magic: [u8; 8],
    /// Newest format version; a file of a newer one is rejected.
    pub version: u32,
    /// Oldest format version; a file of an older one is rejected.
    pub oldest: u32,
    /// What messages call it.
    pub noun: &'static str,
    /// What to do about a damaged one.
    pub remedy: &'static str,
    /// Greatest length of a payload that is decoded, bytes.
    pub payload_max: usize,
}

/// Reason why a file cannot be read or written. Each message names the file and the remedy.
///
/// ```
/// use std::path::Path;
///
/// use motiondb::character;
/// use motiondb::files::database_file;
///
/// let error = database_file::from_bytes(Path::new("notes.fbdb"), b"not a database").unwrap_err();
/// assert!(error.to_string().starts_with("notes.fbdb: not a readable motion database"));
/// let error = character::from_bytes(Path::new("notes.fbchar"), b"not a character").unwrap_err();
/// assert!(error.to_string().starts_with("notes.fbchar: not a readable character"));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The system cannot read the file.
    #[error("{path}: cannot be read: {source}; check that the file exists")]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The system cannot write the file.
    #[error("{path}: cannot be written: {source}; choose another path")]
    Unwritable {
        /// Path of the file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file is of another kind, or is damaged.
    #[error("{path}: not a readable {}: {source}; {}", kind.noun, kind.remedy)]
    Container {
        /// Path of the file.
        path: PathBuf,
        /// What it should be.
        kind: &'static FileKind,
        /// The disagreement found.
        source: ContainerError,
    },
    /// The container is valid, but its payload is not of its kind.
    #[error("{path}: not a readable {}: {reason}; {}", kind.noun, kind.remedy)]
    Decode {
        /// Path of the file.
        path: PathBuf,
        /// What it should be.
        kind: &'static FileKind,
        /// What is wrong with the payload.
        reason: String,
    },
    /// A database can be read, but breaks an invariant.
    #[error("{path}: invariant `{invariant}` is broken: {detail}; `fbcrowd validate` lists all")]
    Invariant {
        /// Path of the file.
        path: PathBuf,
        /// Name of the invariant in `fbcrowd validate`.
        invariant: &'static str,
        /// The fault and its position, as a text for people.
        detail: String,
    },
}

impl FileKind {
    /// The payload of a file of this kind, and its checksum, from the file's bytes.
    ///
    /// # Errors
    /// [`FileError::Container`], and [`FileError::Decode`] where the payload is too long.
    pub fn opened<'a>(&'static self, path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], u32), FileError> {
        let opened = container::open(self.magic, self.version_of(bytes), bytes);
        let (payload, checksum) = opened.map_err(|source| self.container(path, source))?;
        match payload.len() <= self.payload_max {
            true => Ok((payload, checksum)),
            false => Err(self.too_long(path)),
        }
    }

    /// The bytes of a file. Header and length are checked before the rest is read.
    ///
    /// # Errors
    /// [`FileError::Unreadable`], and as [`FileKind::opened`].
    pub fn read(&'static self, path: &Path) -> Result<Vec<u8>, FileError> {
        let unreadable = |source| FileError::Unreadable { path: path.to_owned(), source };
        let mut file = input_file::open(path).map_err(unreadable)?;
        let length = file.metadata().map_err(unreadable)?.len();
        let mut bytes = Vec::new();
        file.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes).map_err(unreadable)?;
        container::check_header(self.magic, self.version_of(&bytes), &bytes, length)
            .map_err(|source| self.container(path, source))?;
        if length > (HEADER_LENGTH + self.payload_max) as u64 {
            return Err(self.too_long(path));
        }
        file.take(self.payload_max as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(bytes)
    }

    /// Writes a payload under its final name, complete or not at all; returns the checksum of the file.
    ///
    /// # Errors
    /// [`FileError::Unwritable`].
    pub fn write(&'static self, path: &Path, bytes: &[u8]) -> Result<u32, FileError> {
        atomic_file::write(path, bytes).map_err(|source| FileError::Unwritable { path: path.to_owned(), source })?;
        Ok(self.opened(path, bytes)?.1)
    }

    /// The format version of a file's bytes where this program reads it; else the newest.
    fn version_of(&self, bytes: &[u8]) -> u32 {
        let is_read = |version: &u32| (self.oldest..=self.version).contains(version);
        container::stated_version(bytes).filter(is_read).unwrap_or(self.version)
    }

    /// The error that a payload is not of this kind.
    pub fn undecoded(&'static self, path: &Path, reason: String) -> FileError {
        FileError::Decode { path: path.to_owned(), kind: self, reason }
    }

    fn container(&'static self, path: &Path, source: ContainerError) -> FileError {
        FileError::Container { path: path.to_owned(), kind: self, source }
    }

    fn too_long(&'static self, path: &Path) -> FileError {
        self.undecoded(path, format!("it is longer than {} MiB", self.payload_max >> 20))
    }
}

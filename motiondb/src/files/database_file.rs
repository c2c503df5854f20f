//! `.fbdb`: a motion database on disk, in a [`container`]. The same clips give the same bytes: it holds no paths, no
//! dates and no order of a hash map.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::files::container::{self, ContainerError, HEADER_LENGTH};
use crate::files::{atomic_file, input_file};
use crate::motion::motion_db::MotionDb;
use crate::validate;

/// Magic number with which a database file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDB";
/// Format version; a file of any other version is rejected.
pub const VERSION: u32 = 2;
/// Greatest length of a payload that is decoded, bytes: 4096 examples of 64 rows take 100 MB.
const PAYLOAD_LIMIT: usize = 256 << 20;

/// Reason why a database cannot be read or written. Each message names the file and the remedy.
///
/// ```
/// use std::path::Path;
///
/// use motiondb::files::database_file;
///
/// let error = database_file::from_bytes(Path::new("notes.fbdb"), b"not a database").unwrap_err();
/// assert!(error.to_string().starts_with("notes.fbdb: not a readable motion database"));
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
    /// The file is not a database, or is damaged.
    #[error("{path}: not a readable motion database: {source}; compile the clips again with `fbcrowd compile`")]
    Container {
        /// Path of the file.
        path: PathBuf,
        /// The disagreement found.
        source: ContainerError,
    },
    /// The container is valid, but its payload is not a database.
    #[error(
        "{path}: not a readable motion database: its content cannot be decoded: {reason}; compile the clips again with \
         `fbcrowd compile`"
    )]
    Decode {
        /// Path of the file.
        path: PathBuf,
        /// The decoder's message.
        reason: String,
    },
    /// The database can be read, but breaks an invariant.
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

/// The bytes of the file of a database.
pub fn to_bytes(db: &MotionDb) -> Vec<u8> {
    let payload =
        bincode::serde::encode_to_vec(db, encoding()).expect("plain data encodes; writing to memory cannot fail");
    container::seal(MAGIC, VERSION, &payload)
}

/// A database and the checksum of its file, from the file's bytes; `path` is used in messages only.
///
/// # Errors
/// [`FileError::Container`] and [`FileError::Decode`].
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<(MotionDb, u32), FileError> {
    let (payload, checksum) = opened(path, bytes)?;
    let decode = |reason: String| FileError::Decode { path: path.to_owned(), reason };
    let (db, used) =
        bincode::serde::decode_from_slice(payload, encoding()).map_err(|error| decode(error.to_string()))?;
    if used != payload.len() {
        return Err(decode(format!("{} bytes follow the database", payload.len() - used)));
    }
    Ok((db, checksum))
}

fn opened<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], u32), FileError> {
    container::open(MAGIC, VERSION, bytes).map_err(|source| FileError::Container { path: path.to_owned(), source })
}

/// Writes a database under its final name, complete or not at all; returns the checksum of its file.
///
/// # Errors
/// [`FileError::Unwritable`].
pub fn write(path: &Path, db: &MotionDb) -> Result<u32, FileError> {
    let bytes = to_bytes(db);
    atomic_file::write(path, &bytes).map_err(|source| FileError::Unwritable { path: path.to_owned(), source })?;
    Ok(opened(path, &bytes)?.1)
}

/// Reads a database and the checksum of its file, without a check of its invariants: for `fbcrowd validate` and
/// `inspect`.
///
/// # Errors
/// All but [`FileError::Invariant`] and [`FileError::Unwritable`].
pub fn read(path: &Path) -> Result<(MotionDb, u32), FileError> {
    from_bytes(path, &container_bytes(path)?)
}

/// The bytes of a file, if its header is that of a database and states no more than [`PAYLOAD_LIMIT`].
fn container_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let unreadable = |source| FileError::Unreadable { path: path.to_owned(), source };
    let mut file = input_file::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    let mut bytes = Vec::new();
    file.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes).map_err(unreadable)?;
    container::check_header(MAGIC, VERSION, &bytes, length)
        .map_err(|source| FileError::Container { path: path.to_owned(), source })?;
    if length > (HEADER_LENGTH + PAYLOAD_LIMIT) as u64 {
        let reason = format!("it is longer than {} MiB", PAYLOAD_LIMIT >> 20);
        return Err(FileError::Decode { path: path.to_owned(), reason });
    }
    file.take(PAYLOAD_LIMIT as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    Ok(bytes)
}

/// Loads a database and the checksum of its file. All invariants hold: the runtime relies on them.
///
/// # Errors
/// All but [`FileError::Unwritable`].
pub fn load(path: &Path) -> Result<(MotionDb, u32), FileError> {
    let (db, checksum) = read(path)?;
    match validate::first_broken(&db) {
        Some((invariant, detail)) => Err(FileError::Invariant { path: path.to_owned(), invariant, detail }),
        None => Ok((db, checksum)),
    }
}

fn encoding() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<PAYLOAD_LIMIT>()
}

//! `.fbdb`: a motion database on disk. Same clips, same bytes: no paths, no dates, no hash-map order.

use std::io;
use std::path::{Path, PathBuf};

use crate::files::container::{self, ContainerError};
use crate::files::{atomic_file, input_file};
use crate::motion::motion_db::MotionDb;
use crate::validate;

/// The mark that a database file begins with.
pub const MAGIC: [u8; 8] = *b"FBCROWDB";
/// Format version: readers refuse any other.
pub const VERSION: u32 = 2;
/// Decoding stops past this many bytes: 4096 examples of 64 rows are 100 MB.
const PAYLOAD_LIMIT: usize = 1 << 30;

/// Why a database cannot be read or written. Each message names the file and what to do.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The system refuses to read.
    #[error("{path}: cannot be read: {source}; check that the file exists")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The system refuses to write.
    #[error("{path}: cannot be written: {source}; choose another place")]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not a database, or a damaged one.
    #[error("{path}: not a readable motion database: {source}; compile the clips anew with `fbcrowd compile`")]
    Container {
        /// The file.
        path: PathBuf,
        /// What disagrees.
        source: ContainerError,
    },
    /// A whole container whose payload is no database.
    #[error(
        "{path}: not a readable motion database: its content cannot be decoded: {reason}; compile the clips anew with \
         `fbcrowd compile`"
    )]
    Decode {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        reason: String,
    },
    /// A readable database that breaks an invariant.
    #[error("{path}: invariant `{invariant}` is broken: {detail}; `fbcrowd validate` lists all")]
    Invariant {
        /// The file.
        path: PathBuf,
        /// Its name in `fbcrowd validate`.
        invariant: &'static str,
        /// Where and how.
        detail: String,
    },
}

/// The file's bytes.
pub fn to_bytes(db: &MotionDb) -> Vec<u8> {
    let payload =
        bincode::serde::encode_to_vec(db, encoding()).expect("plain data encodes; writing to memory cannot fail");
    container::seal(MAGIC, VERSION, &payload)
}

/// A database and the checksum of its file, from the file's bytes; `path` is for messages only.
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

/// Writes a database under its final name whole or not at all; returns the checksum of its file.
///
/// # Errors
/// [`FileError::Unwritable`].
pub fn write(path: &Path, db: &MotionDb) -> Result<u32, FileError> {
    let bytes = to_bytes(db);
    atomic_file::write(path, &bytes).map_err(|source| FileError::Unwritable { path: path.to_owned(), source })?;
    Ok(opened(path, &bytes)?.1)
}

/// Reads a database without judging it: for `fbcrowd validate` and `inspect`.
///
/// # Errors
/// All but [`FileError::Invariant`] and [`FileError::Unwritable`].
pub fn read(path: &Path) -> Result<(MotionDb, u32), FileError> {
    let bytes = input_file::read(path).map_err(|source| FileError::Unreadable { path: path.to_owned(), source })?;
    from_bytes(path, &bytes)
}

/// Reads a database whose invariants all hold, as the runtime relies on; with the checksum of its file.
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

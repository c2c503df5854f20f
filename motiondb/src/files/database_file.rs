//! `.fbdb`: a motion database on disk, in a [`container`]. The same clips give the same bytes: it holds no paths, no
//! dates and no order of a hash map.

use std::path::Path;

use crate::files::container;
pub use crate::files::file_kind::FileError;
use crate::files::file_kind::FileKind;
use crate::motion::motion_db::MotionDb;
use crate::validate;

/// Magic number with which a database file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDB";
/// Format version; a file of any other version is rejected.
pub const VERSION: u32 = 3;
/// Greatest length of a payload that is decoded, bytes: 4096 examples of 64 rows take 100 MB, an hour of actions 90.
const PAYLOAD_LIMIT: usize = 256 << 20;
/// Databases as files.
static KIND: FileKind = FileKind {
    magic: MAGIC,
    version: VERSION,
    noun: "motion database",
    remedy: "compile the clips again with `fbcrowd compile`",
    payload_max: PAYLOAD_LIMIT,
};

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
    let (payload, checksum) = KIND.opened(path, bytes)?;
    let decode = |reason: String| KIND.undecoded(path, format!("its content cannot be decoded: {reason}"));
    let (db, used) =
        bincode::serde::decode_from_slice(payload, encoding()).map_err(|error| decode(error.to_string()))?;
    if used != payload.len() {
        return Err(decode(format!("{} bytes follow the database", payload.len() - used)));
    }
    Ok((db, checksum))
}

/// Writes a database under its final name, complete or not at all; returns the checksum of its file.
///
/// # Errors
/// [`FileError::Unwritable`].
pub fn write(path: &Path, db: &MotionDb) -> Result<u32, FileError> {
    KIND.write(path, &to_bytes(db))
}

/// Reads a database and the checksum of its file, without a check of its invariants: for `fbcrowd validate` and
/// `inspect`.
///
/// # Errors
/// All but [`FileError::Invariant`] and [`FileError::Unwritable`].
pub fn read(path: &Path) -> Result<(MotionDb, u32), FileError> {
    from_bytes(path, &KIND.read(path)?)
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

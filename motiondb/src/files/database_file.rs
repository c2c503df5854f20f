//! `.fbdb`: a motion database on disk, in a [`container`]. The same clips give the same bytes: it holds no paths, no
//! dates and no order of a hash map.
//!
//! The payload is the database; where the set has styles, the name of its style and the further styles, each a name and
//! a database, follow.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

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
    let mut payload = encoded(db);
    if db.has_styles() {
        let further: Vec<(&str, &MotionDb)> = db.further_styles.iter().map(|db| (db.style.as_str(), db)).collect();
        payload.extend(encoded(&(&db.style, further)));
    }
    container::seal(MAGIC, VERSION, &payload)
}

fn encoded(content: &impl Serialize) -> Vec<u8> {
    bincode::serde::encode_to_vec(content, encoding()).expect("plain data encodes; writing to memory cannot fail")
}

/// A database and the checksum of its file, from the file's bytes; `path` is used in messages only.
///
/// # Errors
/// [`FileError::Container`] and [`FileError::Decode`].
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<(MotionDb, u32), FileError> {
    let (payload, checksum) = KIND.opened(path, bytes)?;
    let decode = |reason: String| KIND.undecoded(path, format!("its content cannot be decoded: {reason}"));
    let (mut db, mut rest): (MotionDb, &[u8]) = decoded(payload).map_err(decode)?;
    if !rest.is_empty() {
        let no_styles =
            |reason: String| format!("{} bytes follow the database, which are no styles: {reason}", rest.len());
        let styles: (String, Vec<(String, MotionDb)>);
        (styles, rest) = decoded(rest).map_err(|reason| decode(no_styles(reason)))?;
        let further = styles.1.into_iter();
        (db.style, db.further_styles) = (styles.0, further.map(|(style, db)| MotionDb { style, ..db }).collect());
    }
    if !rest.is_empty() {
        return Err(decode(format!("{} bytes follow the database", rest.len())));
    }
    Ok((db, checksum))
}

/// What some bytes begin with, and the bytes after it; or why they cannot be decoded.
fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> Result<(T, &[u8]), String> {
    let (content, used) = bincode::serde::decode_from_slice(bytes, encoding()).map_err(|error| error.to_string())?;
    Ok((content, &bytes[used..]))
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

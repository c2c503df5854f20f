//! `.fbdb`: a motion database on disk, in a [`container`]. The same clips give the same bytes: it holds no paths, no
//! dates and no order of a hash map.
//!
//! The payload is the database; where the set has styles, the name of its style and the further styles, each a name and
//! a database, follow. Where the set has joints beside the 22 roles, the format version is [`EXTRA_VERSION`], and the
//! motion of these joints follows each database. Any other set has [`VERSION`].

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::files::container;
pub use crate::files::file_kind::FileError;
use crate::files::file_kind::FileKind;
use crate::motion::extra_motion::ExtraMotion;
use crate::motion::motion_db::MotionDb;
use crate::validate;

/// Magic number with which a database file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDB";
/// Format version of a database of the 22 roles alone.
pub const VERSION: u32 = 3;
/// Format version of a database with extra joints; a newer one is rejected, as is one older than [`VERSION`].
pub const EXTRA_VERSION: u32 = 4;
/// Greatest length of a payload that is decoded, bytes: 4096 examples of 64 rows take 100 MB, an hour of actions 90.
const PAYLOAD_LIMIT: usize = 256 << 20;
/// Databases as files.
static KIND: FileKind = FileKind {
    magic: MAGIC,
    version: EXTRA_VERSION,
    oldest: VERSION,
    noun: "motion database",
    remedy: "compile the clips again with `fbcrowd compile`",
    payload_max: PAYLOAD_LIMIT,
};

/// The bytes of the file of a database.
pub fn to_bytes(db: &MotionDb) -> Vec<u8> {
    let mut payload = encoded(db);
    if db.has_extra_joints() {
        payload.extend(encoded(&db.extra));
        if db.has_styles() {
            let further = db.further_styles.iter().map(|db| (db.style.as_str(), db, &db.extra));
            payload.extend(encoded(&(&db.style, further.collect::<Vec<_>>())));
        }
        return container::seal(MAGIC, EXTRA_VERSION, &payload);
    }
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
    let has_extra_joints = container::stated_version(bytes) == Some(EXTRA_VERSION);
    let (mut db, mut rest): (MotionDb, &[u8]) = decoded(payload).map_err(decode)?;
    if has_extra_joints {
        let no_joints = |reason: String| decode(format!("its extra joints are damaged: {reason}"));
        (db.extra, rest) = decoded(rest).map_err(no_joints)?;
    }
    if !rest.is_empty() {
        let count = rest.len();
        let no_styles =
            |reason: String| decode(format!("{count} bytes follow the database, which are no styles: {reason}"));
        let styles = if has_extra_joints { decoded_styles(rest) } else { decoded_plain_styles(rest) };
        ((db.style, db.further_styles), rest) = styles.map_err(no_styles)?;
    }
    if !rest.is_empty() {
        return Err(decode(format!("{} bytes follow the database", rest.len())));
    }
    Ok((db, checksum))
}

/// The name of the first style, and the further styles.
type Styles = (String, Vec<MotionDb>);
/// The same as the file holds them.
type StoredStyles<T> = (String, Vec<T>);

/// The styles of a set of the 22 roles alone, and the bytes after them.
fn decoded_plain_styles(bytes: &[u8]) -> Result<(Styles, &[u8]), String> {
    let ((style, further), rest): (StoredStyles<(String, MotionDb)>, _) = decoded(bytes)?;
    let further = further.into_iter().map(|(style, db)| MotionDb { style, ..db });
    Ok(((style, further.collect()), rest))
}

/// The styles of a set with extra joints, and the bytes after them.
fn decoded_styles(bytes: &[u8]) -> Result<(Styles, &[u8]), String> {
    let ((style, further), rest): (StoredStyles<(String, MotionDb, ExtraMotion)>, _) = decoded(bytes)?;
    let further = further.into_iter().map(|(style, db, extra)| MotionDb { style, extra, ..db });
    Ok(((style, further.collect()), rest))
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

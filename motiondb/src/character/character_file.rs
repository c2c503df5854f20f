//! `.fbchar`: a character on disk, in a [`container`]. The same source file gives the same bytes.
//!
//! The payload is the character. Where it has joints beside the 22 roles, the format version is [`EXTRA_VERSION`], and the
//! list of these joints follows. Any other character has [`VERSION`].

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::character::check::first_fault;
use crate::character::model::Character;
use crate::files::container;
use crate::files::file_kind::{FileError, FileKind};

/// Magic number with which a character file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDC";
/// Format version of a character of the 22 roles alone.
pub const VERSION: u32 = 2;
/// Format version of a character with extra joints; a newer one is rejected, as is one older than [`VERSION`].
pub const EXTRA_VERSION: u32 = 3;
/// Greatest length of a payload that is decoded, bytes: the most vertices and triangles take 110 MB, textures 64 MB.
const PAYLOAD_LIMIT: usize = 192 << 20;
/// Characters as files.
static KIND: FileKind = FileKind {
    magic: MAGIC,
    version: EXTRA_VERSION,
    oldest: VERSION,
    noun: "character",
    remedy: "compile it again with `fbcrowd compile`",
    payload_max: PAYLOAD_LIMIT,
};

/// The bytes of the file of a character.
pub fn to_bytes(character: &Character) -> Vec<u8> {
    let mut payload = encoded(character);
    if character.extra.is_empty() {
        return container::seal(MAGIC, VERSION, &payload);
    }
    payload.extend(encoded(&character.extra));
    container::seal(MAGIC, EXTRA_VERSION, &payload)
}

fn encoded(content: &impl Serialize) -> Vec<u8> {
    bincode::serde::encode_to_vec(content, encoding()).expect("plain data encodes; writing to memory cannot fail")
}

/// A character and the checksum of its file, from the file's bytes. All invariants hold; `path` is used in messages
/// only.
///
/// # Errors
/// [`FileError::Container`] and [`FileError::Decode`].
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<(Character, u32), FileError> {
    let (payload, checksum) = KIND.opened(path, bytes)?;
    let decode = |reason: String| KIND.undecoded(path, reason);
    let (mut character, mut rest): (Character, &[u8]) = decoded(payload).map_err(decode)?;
    if container::stated_version(bytes) == Some(EXTRA_VERSION) {
        (character.extra, rest) = decoded(rest).map_err(decode)?;
    }
    if !rest.is_empty() {
        return Err(decode(format!("{} bytes follow the character", rest.len())));
    }
    match first_fault(&character) {
        Some(fault) => Err(decode(fault)),
        None => Ok((character, checksum)),
    }
}

/// What some bytes begin with, and the bytes after it; or why they cannot be decoded.
fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> Result<(T, &[u8]), String> {
    let (content, used) = bincode::serde::decode_from_slice(bytes, encoding()).map_err(|error| error.to_string())?;
    Ok((content, &bytes[used..]))
}

/// Writes a character under its final name, complete or not at all; returns the checksum of its file.
///
/// # Errors
/// [`FileError::Unwritable`].
pub fn write(path: &Path, character: &Character) -> Result<u32, FileError> {
    KIND.write(path, &to_bytes(character))
}

/// Loads a character and the checksum of its file. Header and length are checked before the rest is read.
///
/// # Errors
/// All but [`FileError::Unwritable`].
pub fn load(path: &Path) -> Result<(Character, u32), FileError> {
    from_bytes(path, &KIND.read(path)?)
}

fn encoding() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<PAYLOAD_LIMIT>()
}

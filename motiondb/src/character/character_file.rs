//! `.fbchar`: a character on disk, in a [`container`]. The same source file gives the same bytes.

use std::path::Path;

use crate::character::check::first_fault;
use crate::character::model::Character;
use crate::files::container;
use crate::files::file_kind::{FileError, FileKind};

/// Magic number with which a character file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDC";
/// Format version; a file of any other version is rejected.
pub const VERSION: u32 = 2;
/// Greatest length of a payload that is decoded, bytes: the most vertices and triangles take 110 MB, textures 64 MB.
const PAYLOAD_LIMIT: usize = 192 << 20;
/// Characters as files.
static KIND: FileKind = FileKind {
    magic: MAGIC,
    version: VERSION,
    oldest: VERSION,
    noun: "character",
    remedy: "compile it again with `fbcrowd compile`",
    payload_max: PAYLOAD_LIMIT,
};

/// The bytes of the file of a character.
pub fn to_bytes(character: &Character) -> Vec<u8> {
    let payload = bincode::serde::encode_to_vec(character, encoding())
        .expect("plain data encodes; writing to memory cannot fail");
    container::seal(MAGIC, VERSION, &payload)
}

/// A character and the checksum of its file, from the file's bytes. All invariants hold; `path` is used in messages
/// only.
///
/// # Errors
/// [`FileError::Container`] and [`FileError::Decode`].
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<(Character, u32), FileError> {
    let (payload, checksum) = KIND.opened(path, bytes)?;
    let decode = |reason: String| KIND.undecoded(path, reason);
    let (character, used) =
        bincode::serde::decode_from_slice(payload, encoding()).map_err(|error| decode(error.to_string()))?;
    if used != payload.len() {
        return Err(decode(format!("{} bytes follow the character", payload.len() - used)));
    }
    match first_fault(&character) {
        Some(fault) => Err(decode(fault)),
        None => Ok((character, checksum)),
    }
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

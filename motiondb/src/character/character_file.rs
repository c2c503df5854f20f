//! `.fbchar`: a character on disk, in a [`container`]. The same source file gives the same bytes.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::character::check::first_fault;
use crate::character::model::Character;
use crate::files::container::{self, ContainerError, HEADER_LENGTH};
use crate::files::{atomic_file, input_file};

/// Magic number with which a character file begins.
pub const MAGIC: [u8; 8] = *b"FBCROWDC";
/// Format version; a file of any other version is rejected.
pub const VERSION: u32 = 2;
/// Greatest length of a payload that is decoded, bytes: the most vertices and triangles take 110 MB, textures 64 MB.
const PAYLOAD_LIMIT: usize = 192 << 20;

/// Reason why a character cannot be read or written. Each message names the file and the remedy.
///
/// ```
/// use std::path::Path;
///
/// let error = motiondb::character::from_bytes(Path::new("notes.fbchar"), b"not a character").unwrap_err();
/// assert!(error.to_string().starts_with("notes.fbchar: not a readable character"));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum CharacterFileError {
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
    /// The file is not a character, or is damaged.
    #[error("{path}: not a readable character: {source}; compile it again with `fbcrowd compile`")]
    Container {
        /// Path of the file.
        path: PathBuf,
        /// The disagreement found.
        source: ContainerError,
    },
    /// The container is valid, but its payload is not a character.
    #[error("{path}: not a readable character: {reason}; compile it again with `fbcrowd compile`")]
    Decode {
        /// Path of the file.
        path: PathBuf,
        /// What is wrong with the payload.
        reason: String,
    },
}

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
/// [`CharacterFileError::Container`] and [`CharacterFileError::Decode`].
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<(Character, u32), CharacterFileError> {
    let (payload, checksum) = opened(path, bytes)?;
    let decode = |reason: String| CharacterFileError::Decode { path: path.to_owned(), reason };
    if payload.len() > PAYLOAD_LIMIT {
        return Err(decode(format!("it is longer than {} MiB", PAYLOAD_LIMIT >> 20)));
    }
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

fn opened<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], u32), CharacterFileError> {
    container::open(MAGIC, VERSION, bytes)
        .map_err(|source| CharacterFileError::Container { path: path.to_owned(), source })
}

/// Writes a character under its final name, complete or not at all; returns the checksum of its file.
///
/// # Errors
/// [`CharacterFileError::Unwritable`].
pub fn write(path: &Path, character: &Character) -> Result<u32, CharacterFileError> {
    let bytes = to_bytes(character);
    atomic_file::write(path, &bytes)
        .map_err(|source| CharacterFileError::Unwritable { path: path.to_owned(), source })?;
    Ok(opened(path, &bytes)?.1)
}

/// Loads a character and the checksum of its file. Header and length are checked before the rest is read.
///
/// # Errors
/// All but [`CharacterFileError::Unwritable`].
pub fn load(path: &Path) -> Result<(Character, u32), CharacterFileError> {
    let unreadable = |source| CharacterFileError::Unreadable { path: path.to_owned(), source };
    let mut file = input_file::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    let mut bytes = Vec::new();
    file.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes).map_err(unreadable)?;
    container::check_header(MAGIC, VERSION, &bytes, length)
        .map_err(|source| CharacterFileError::Container { path: path.to_owned(), source })?;
    file.take(PAYLOAD_LIMIT as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    from_bytes(path, &bytes)
}

fn encoding() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<PAYLOAD_LIMIT>()
}

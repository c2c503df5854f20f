//! Reading what a user names: regular files only, since a device or a pipe may never end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Opens a file.
///
/// # Errors
/// Where the system refuses, or `path` is a folder, a device or a pipe (which opening alone would wait for).
pub fn open(path: &Path) -> io::Result<File> {
    let found = fs::metadata(path)?;
    if !found.is_file() {
        let what = if found.is_dir() { "a folder, not a file" } else { "not a regular file" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    File::open(path)
}

/// All its bytes.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Whether bytes are a text in UTF-16, with or without byte order mark: without one, every other of the first is zero,
/// which no UTF-8 has.
pub fn is_utf16(bytes: &[u8]) -> bool {
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [a, b, c, d, ..] => {
            matches!([a, b, c, d].map(|byte| *byte == 0), [true, false, true, false] | [false, true, false, true])
        }
        _ => false,
    }
}

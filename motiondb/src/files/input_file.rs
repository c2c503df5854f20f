//! Reading of files that a user names: regular files only, since a device or a pipe may never end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Opens a regular file.
///
/// # Errors
/// If the system cannot open it, or `path` is a folder, a device or a pipe (to open one would already block).
pub fn open(path: &Path) -> io::Result<File> {
    let found = fs::metadata(path)?;
    if !found.is_file() {
        let kind = if found.is_dir() { "a folder, not a file" } else { "not a regular file" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, kind));
    }
    File::open(path)
}

/// All bytes of a regular file.
///
/// # Errors
/// As [`open`], or if reading fails.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Whether bytes are a text in UTF-16, with or without byte order mark. Without one, every second of the first bytes is
/// zero, which does not occur in UTF-8.
pub fn is_utf16(bytes: &[u8]) -> bool {
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [a, b, c, d, ..] => {
            matches!([a, b, c, d].map(|byte| *byte == 0), [true, false, true, false] | [false, true, false, true])
        }
        _ => false,
    }
}

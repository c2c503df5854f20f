//! Reading of files that a user names: regular files only, since a device or a pipe may never end; and which failures
//! are the machine's.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Opens a regular file.
///
/// # Errors
/// If the system cannot open it, or `path` is a folder, a device or a pipe (to open one would already block).
pub fn open(path: &Path) -> io::Result<File> {
    let found = fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::PermissionDenied => error,
        _ if path.is_symlink() => io::Error::new(ErrorKind::InvalidInput, "a link that leads to no file"),
        _ => error,
    })?;
    if !found.is_file() {
        let kind = if found.is_dir() { "a folder, not a file" } else { "not a regular file" };
        return Err(io::Error::new(ErrorKind::InvalidInput, kind));
    }
    File::open(path)
}

/// Whether the machine failed to read a file (disk, memory), so that a retry may help. Otherwise the path or the file's
/// content is wrong.
pub fn is_of_machine(error: &io::Error) -> bool {
    use ErrorKind::{
        InvalidData, InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound, PermissionDenied,
        UnexpectedEof, Unsupported,
    };

    !matches!(
        error.kind(),
        NotFound
            | PermissionDenied
            | InvalidData
            | InvalidInput
            | InvalidFilename
            | IsADirectory
            | NotADirectory
            | UnexpectedEof
            | Unsupported
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_disk_is_the_machines_fault() {
        for (error, is_fault) in [
            (io::Error::from_raw_os_error(5), true),
            (ErrorKind::OutOfMemory.into(), true),
            (ErrorKind::NotFound.into(), false),
            (open(Path::new("/")).unwrap_err(), false),
            (open(Path::new("/dev/null")).unwrap_err(), false),
        ] {
            assert_eq!(is_of_machine(&error), is_fault, "{error}");
        }
    }
}

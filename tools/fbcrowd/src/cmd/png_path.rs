//! The path of a picture that is always PNG.

use std::path::Path;

use crate::terminal::failure::Failure;

/// Checks that a path ends in `.png`, so that no other extension names the bytes of a PNG file.
pub(crate) fn check_is_png(path: &Path) -> Result<(), Failure> {
    match path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        true => Ok(()),
        false => Err(Failure::bad(format!("{}: pictures are PNG files; name one *.png", path.display()))),
    }
}

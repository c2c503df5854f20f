//! What the fuzz targets share.

use std::fs;
use std::path::PathBuf;

/// Puts bytes under a name that only this process uses, for what is read by path.
///
/// # Panics
/// If the folder for temporary files cannot be written.
pub fn on_disk(extension: &str, bytes: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("fbcrowd_fuzz_{}.{extension}", std::process::id()));
    fs::write(&path, bytes).expect("the folder for temporary files can be written");
    path
}

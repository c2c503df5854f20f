//! Clips of others, for all tests of this crate.
#![allow(dead_code, unreachable_pub, reason = "each test target uses its own part")]

use std::env;
use std::path::{Path, PathBuf};

/// The folder of other people's clips. Tests that need it are ignored unless it is given.
pub fn mocap() -> PathBuf {
    let folder = env::var_os("FBCROWD_MOCAP").map(PathBuf::from);
    let folder = folder.expect("set FBCROWD_MOCAP to the folder of other people's clips, as an absolute path");
    assert!(folder.is_dir(), "FBCROWD_MOCAP: {} is no folder", folder.display());
    folder
}

/// The folder of the bundled clips.
pub fn bundled_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips")
}

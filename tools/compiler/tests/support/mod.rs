//! Clips of others, for all tests of this crate.
#![allow(unreachable_pub, reason = "each test target uses it as its own")]

use std::env;
use std::path::PathBuf;

/// The folder of other people's clips. Tests that need it are ignored unless it is given.
pub fn mocap() -> PathBuf {
    let folder = env::var_os("FBCROWD_MOCAP").map(PathBuf::from);
    let folder = folder.expect("set FBCROWD_MOCAP to the folder of other people's clips, as an absolute path");
    assert!(folder.is_dir(), "FBCROWD_MOCAP: {} is no folder", folder.display());
    folder
}

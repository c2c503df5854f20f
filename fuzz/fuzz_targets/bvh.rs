//! Any bytes as a BVH file: an import or an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use motiondb_compiler::import::import_bytes;

fuzz_target!(|bytes: &[u8]| {
    let _ = import_bytes(Path::new("clip.bvh"), bytes);
});

//! Any bytes as a glTF or GLB file: imports or an error. Buffers beside the file are looked for where nothing is.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use motiondb_compiler::import_bytes;

fuzz_target!(|bytes: &[u8]| {
    let _ = import_bytes(Path::new("/nowhere/clip.glb"), bytes);
});

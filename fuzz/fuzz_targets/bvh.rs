//! Any bytes as a BVH file: an import or an error; what is imported compiles or is rejected.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use motiondb_compiler::{Options, compile, import_bytes};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(imports) = import_bytes(Path::new("clip.bvh"), bytes) {
        let clips = imports.into_iter().filter_map(|import| import.outcome.ok()).collect();
        let _ = compile(clips, &Options::default(), &|_| ());
    }
});

//! Any bytes as a database: as they are, and sealed with a right header, so that decoding and validation are reached.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use motiondb::{container, file, validate};

/// As in `motiondb::file`.
const MAGIC: [u8; 8] = *b"FBCROWDB";
const HEADER_BYTES: usize = 24;

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("any.fbdb");
    let _ = file::from_bytes(path, bytes);
    let payload = bytes.get(HEADER_BYTES..).unwrap_or_default();
    if let Ok((db, _)) = file::from_bytes(path, &container::seal(MAGIC, file::VERSION, payload)) {
        let _ = validate::validate(&db);
    }
});

//! Any bytes as a database: as they are, and sealed with a right header, so that decoding and validation are reached;
//! a valid database is measured.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use motiondb::files::database_file;
use motiondb::quality::{action_quality, example_quality};
use motiondb::validate;
use motiondb::files::container::{self, HEADER_LENGTH};

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("any.fbdb");
    let _ = database_file::from_bytes(path, bytes);
    let payload = bytes.get(HEADER_LENGTH..).unwrap_or_default();
    for version in [database_file::VERSION, database_file::EXTRA_VERSION] {
        let sealed = container::seal(database_file::MAGIC, version, payload);
        let Ok((db, _)) = database_file::from_bytes(path, &sealed) else { continue };
        if validate::validate(&db).iter().all(|check| check.broken.is_none()) {
            let _ = (example_quality::lint(&db), action_quality::lint(&db));
        }
    }
});

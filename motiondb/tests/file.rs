//! `.fbdb`: a written database is read again; any other file is rejected with its name.

mod support;

use std::fs;
use std::path::{Path, PathBuf};

use motiondb::files::database_file::{self, FileError};
use proptest::prelude::*;
use support::small_db;

fn path_of(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

#[test]
fn a_written_database_is_read_again() {
    let folder = path_of("round_trip");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("motion.fbdb");
    let checksum = database_file::write(&path, &small_db()).unwrap();
    assert_eq!(database_file::load(&path).unwrap(), (small_db(), checksum));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn each_failure_has_its_own_error() {
    assert!(matches!(database_file::read(&path_of("nothing.fbdb")), Err(FileError::Unreadable { .. })));
    assert!(matches!(
        database_file::write(&path_of("nowhere/motion.fbdb"), &small_db()),
        Err(FileError::Unwritable { .. })
    ));
    let foreign = path_of("foreign.fbdb");
    fs::write(&foreign, "HIERARCHY\nROOT Hips\n").unwrap();
    let message = database_file::read(&foreign).unwrap_err().to_string();
    assert!(message.contains("foreign.fbdb") && message.contains("fbcrowd compile"), "{message}");
}

#[test]
fn a_broken_invariant_is_read_but_not_loaded() {
    let path = path_of("broken.fbdb");
    let mut db = small_db();
    db.blend_space.covered_share = 0.5;
    database_file::write(&path, &db).unwrap();
    assert!(database_file::read(&path).is_ok());
    let invariant = "simplices_tile_the_hull";
    assert!(
        matches!(database_file::load(&path), Err(FileError::Invariant { invariant: found, .. }) if found == invariant)
    );
}

proptest! {
    #[test]
    fn no_altered_or_cut_file_is_read(share in 0.0f64..1.0, bit in 0u8..8, cut in any::<bool>()) {
        let mut bytes = database_file::to_bytes(&small_db());
        let offset = (share * bytes.len() as f64) as usize;
        if cut {
            bytes.truncate(offset);
        } else {
            bytes[offset] ^= 1 << bit;
        }
        prop_assert!(database_file::from_bytes(Path::new("altered"), &bytes).is_err());
    }
}

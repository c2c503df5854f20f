//! `.fbdb`: a written database is read again; any other file is rejected with its name.

mod support;

use std::fs;
use std::path::{Path, PathBuf};

use motiondb::MotionDb;
use motiondb::files::container::{self, HEADER_LENGTH};
use motiondb::files::database_file::{self, FileError};
use proptest::prelude::*;
use support::{db_with_fingers, small_db};

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

#[track_caller]
fn check_read_again(db: &MotionDb, version: u32) {
    let bytes = database_file::to_bytes(db);
    assert_eq!(container::stated_version(&bytes), Some(version));
    assert_eq!(&database_file::from_bytes(Path::new("kept"), &bytes).unwrap().0, db);
}

#[test]
fn only_sets_with_extra_joints_have_a_newer_version() {
    let styled = |db: MotionDb| MotionDb {
        further_styles: vec![MotionDb { style: "elderly".into(), ..db.clone() }],
        style: "neutral".into(),
        ..db
    };
    for (db, version) in [(small_db(), 3), (db_with_fingers(), 4)] {
        check_read_again(&db, version);
        check_read_again(&styled(db), version);
    }
    let (without, with) = (database_file::to_bytes(&small_db()), database_file::to_bytes(&db_with_fingers()));
    let rotations = db_with_fingers().extra;
    let added = 16 * (rotations.rotations.len() + rotations.actions.concat().len());
    assert!((added..added + 100).contains(&(with.len() - without.len())));
    assert_eq!(with[HEADER_LENGTH..without.len()], without[HEADER_LENGTH..]);
}

#[test]
fn unknown_and_endless_extra_joints_are_refused() {
    let plain = database_file::to_bytes(&small_db())[HEADER_LENGTH..].to_vec();
    for damaged in [&[][..], &[1, 0, 0, 0, 0, 0, 0, 0, 200], &[255; 8], &[0; 23], &[0; 25]] {
        let sealed = container::seal(database_file::MAGIC, 4, &[&plain, damaged].concat());
        assert!(database_file::from_bytes(Path::new("damaged"), &sealed).is_err(), "{damaged:?}");
    }
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
        let mut bytes = database_file::to_bytes(&db_with_fingers());
        let offset = (share * bytes.len() as f64) as usize;
        if cut {
            bytes.truncate(offset);
        } else {
            bytes[offset] ^= 1 << bit;
        }
        prop_assert!(database_file::from_bytes(Path::new("altered"), &bytes).is_err());
    }
}

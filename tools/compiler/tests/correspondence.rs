//! Correspondence tables between any two examples of the bundled clips.

use std::path::Path;

use motiondb::motion::{MotionDb, PosePair, THRESHOLD_RATIO, distances_m, pose_pairs};
use motiondb_compiler::input::manifest::Manifest;
use motiondb_compiler::{clip_files, compile_manifest};

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

fn bundled() -> MotionDb {
    let files = clip_files(Path::new(BUNDLED)).unwrap();
    compile_manifest(&Manifest::of_files(&files), &|_| ()).unwrap().db
}

/// Every table between two different examples.
fn tables(db: &MotionDb) -> impl Iterator<Item = ([usize; 2], Vec<PosePair>)> + '_ {
    let count = db.examples.len();
    let pairs = (0..count * count).map(move |pair| [pair / count, pair % count]).filter(|[from, to]| from != to);
    pairs.map(|pair| (pair, pose_pairs(db, pair[0], pair[1])))
}

#[test]
fn tables_are_monotone_cyclic_and_serve_every_step() {
    let db = bundled();
    for (pair, table) in tables(&db) {
        for (axis, &example) in pair.iter().enumerate() {
            let times_s: Vec<f32> = table.iter().map(|alike| alike.times_s[axis]).collect();
            let falls = (0..times_s.len()).filter(|&k| times_s[(k + 1) % times_s.len()] <= times_s[k]).count();
            assert_eq!(falls, 1, "{pair:?}: {times_s:?}");
            let map = db.examples[example].phase_map;
            for step in 0..2 {
                let serves = |time_s: &f32| (map.phase(time_s + 1e-4) >= 0.5) == (step == 1);
                assert!(times_s.iter().any(serves), "{pair:?}: {times_s:?}");
            }
        }
    }
}

#[test]
fn reversed_tables_have_the_same_pairs() {
    let db = bundled();
    for ([from, to], table) in tables(&db).filter(|([from, to], _)| from < to) {
        let mut reversed = motiondb::motion::pose_pairs(&db, to, from);
        reversed.iter_mut().for_each(|alike| alike.times_s.reverse());
        reversed.sort_by(|a, b| a.times_s[0].total_cmp(&b.times_s[0]));
        assert_eq!(reversed, table);
    }
}

#[test]
fn stored_table_holds_nearest_poses() {
    let db = bundled();
    let stored = db.correspondence.as_ref().unwrap();
    let [sp, mb] = [stored.semi_procedural, stored.blending].map(|index| index as usize);
    let table = pose_pairs(&db, sp, mb);
    assert_eq!(stored.pairs_s, table.iter().map(|alike| alike.times_s).collect::<Vec<_>>());
    let least_m = distances_m(&db, sp, mb).into_iter().flatten().fold(f32::INFINITY, f32::min);
    let nearest_m = table.iter().map(|alike| alike.distance_m).fold(f32::INFINITY, f32::min);
    assert_eq!(nearest_m, least_m);
    assert!(table.iter().all(|alike| alike.distance_m <= THRESHOLD_RATIO * least_m), "{table:?}");
}

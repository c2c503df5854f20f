//! A clip's gait is its performer's, independent of other clips (real clips are test input only).

mod support;

use std::path::{Path, PathBuf};

use motiondb::motion::{MotionExample, PHASE_COUNT};
use motiondb_compiler::compile_files;
use support::mocap;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");
/// Clips of performers of different proportions and soles.
const CLIPS: [&str; 6] = [
    "bandai_namco/dataset-1_walk_normal_001.bvh",
    "bandai_namco/dataset-1_walk-back_masculinity_001.bvh",
    "smartbody_converted/ChrMarine_Walk01.bvh",
    "smartbody_converted/ChrMarine_Jog01.bvh",
    "smartbody_converted/ChrMarine_WalkCircleRt01.bvh",
    "cmu_cgspeed/02_01.bvh",
];

/// The recorded examples of some clips that step, of all styles.
fn examples(files: &[PathBuf]) -> Vec<MotionExample> {
    let db = compile_files(files, &|_| ()).unwrap().db;
    let examples = db.styles().flat_map(|db| db.examples.clone());
    examples.filter(|example| !example.mirrored && example.key_times_s.is_some()).collect()
}

/// Fails unless an example's key times are those of the same clip compiled alone, to within a row.
#[track_caller]
fn check_same_key_times(alone: &MotionExample, beside: &MotionExample) {
    let period_s = alone.phase_map.period_s;
    assert!((beside.phase_map.period_s - period_s).abs() < 1e-3, "{alone:?}, beside others {beside:?}");
    let row_s = period_s / PHASE_COUNT as f32;
    for (alone_s, beside_s) in alone.key_times_s.unwrap().into_iter().zip(beside.key_times_s.unwrap()) {
        let off_s = (alone_s - beside_s).abs();
        assert!(off_s.min(period_s - off_s) < row_s, "{alone:?}, beside others {beside:?}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn key_times_are_independent_of_other_clips() {
    let mut files: Vec<PathBuf> = CLIPS.iter().map(|file| mocap().join(file)).collect();
    let alone: Vec<MotionExample> = files.iter().flat_map(|file| examples(std::slice::from_ref(file))).collect();
    files.extend(["walk_110.bvh", "walk_050.bvh", "run_350.bvh"].map(|file| Path::new(BUNDLED).join(file)));
    let beside = examples(&files);
    let mut compared = 0;
    for alone in &alone {
        // Some of a capture's windows may add nothing to other clips.
        if let Some(beside) = beside.iter().find(|example| example.name == alone.name) {
            check_same_key_times(alone, beside);
            compared += 1;
        }
    }
    assert!(compared >= CLIPS.len(), "{compared} of {}", alone.len());
}

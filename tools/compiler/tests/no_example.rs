//! A whole folder may be compiled: transitions, jumps, dances, deaths and crawling give no example (real clips, test
//! input only).

mod support;

use std::path::PathBuf;

use motiondb::remark::Weight;
use motiondb_compiler::compile::compile_files;
use support::mocap;

/// Compiles clips and checks that of `clips` none gave an example and each was told why.
fn check_none(files: &[PathBuf], clips: &[&str]) {
    let db = compile_files(files, &|_| ()).unwrap().db;
    for clip in clips {
        assert!(!db.examples.iter().any(|example| example.name.contains(clip)), "{clip} gave an example");
        let source = db.sources.iter().find(|source| source.file.contains(clip) || source.clip.contains(clip)).unwrap();
        let told = source.warnings.iter().any(|remark| remark.weight() == Weight::NoExample);
        assert!(told, "{clip}: {:?}", source.warnings);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn transitions_between_standing_and_walking_are_no_examples() {
    let folder = mocap().join("smartbody_converted");
    let clips = ["StepBackwardsRt01", "StepForwardRt01", "StepSidewaysRt01", "Idle01_ToWalk01", "Walk01_ToIdle01"];
    let files = motiondb_compiler::import::clip_files(&folder).unwrap();
    check_none(&files, &clips);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn what_is_no_gait_is_no_example() {
    let folder = mocap().join("gltf");
    let files = motiondb_compiler::import::clip_files(&folder).unwrap();
    check_none(&files, &["Dance", "Death", "Jump", "Punch", "Sitting", "Crawling", "Crouching", "Dodge_Left", "TPose"]);
}

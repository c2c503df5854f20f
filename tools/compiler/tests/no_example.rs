//! Transitions, jumps, dances, deaths and crawling give no example (real clips, test input only).

use std::path::{Path, PathBuf};

use motiondb::diagnostic::Diagnostic;
use motiondb_compiler::{clip_files, compile_files};

const MOCAP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/mocap");

/// Compiles files and checks that none of `clips` gives an example and each has a reason.
fn check_none(files: &[PathBuf], clips: &[&str]) {
    let db = compile_files(files, &|_| ()).unwrap().db;
    for clip in clips {
        assert!(!db.examples.iter().any(|example| example.name.contains(clip)), "{clip} gave an example");
        let source = db.sources.iter().find(|source| source.file.contains(clip) || source.clip.contains(clip)).unwrap();
        let has_reason = source.diagnostics.iter().any(|found| matches!(found, Diagnostic::NoExample(_)));
        assert!(has_reason, "{clip}: {:?}", source.diagnostics);
    }
}

fn folder(test: &str, name: &str) -> Option<PathBuf> {
    let folder = Path::new(MOCAP).join(name);
    if !folder.is_dir() {
        println!("SKIPPED {test}: {} is missing", folder.display());
        return None;
    }
    Some(folder)
}

#[test]
fn transitions_between_standing_and_walking_are_no_examples() {
    let test = "transitions_between_standing_and_walking_are_no_examples";
    let Some(folder) = folder(test, "smartbody_converted") else { return };
    let clips = ["StepBackwardsRt01", "StepForwardRt01", "StepSidewaysRt01", "Idle01_ToWalk01", "Walk01_ToIdle01"];
    let files = clip_files(&folder).unwrap();
    check_none(&files, &clips);
}

#[test]
fn what_is_no_gait_is_no_example() {
    let Some(folder) = folder("what_is_no_gait_is_no_example", "gltf") else { return };
    let files = clip_files(&folder).unwrap();
    check_none(&files, &["Dance", "Death", "Jump", "Punch", "Sitting", "Crawling", "Crouching", "Dodge_Left", "TPose"]);
}

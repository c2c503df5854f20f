//! Transitions, jumps, dances, deaths and crawling give no example (real clips, test input only).

mod support;

use std::path::PathBuf;

use motiondb::diagnostic::{Diagnostic, Note, Severity};
use motiondb_compiler::{clip_files, compile_files};
use support::mocap;

/// Compiles files and checks that none of `clips` gives an example and each has a reason of this severity.
fn check_none(files: &[PathBuf], clips: &[&str], severity: Severity) {
    let db = compile_files(files, &|_| ()).unwrap().db;
    for clip in clips {
        assert!(!db.examples.iter().any(|example| example.name.contains(clip)), "{clip} gave an example");
        let source = db.sources.iter().find(|source| source.file.contains(clip) || source.clip.contains(clip)).unwrap();
        let is_reason = |found: &Diagnostic| match found {
            Diagnostic::NoExample(_) => severity == Severity::NoExample,
            Diagnostic::Note(Note::OnlyTransitionsUsed { .. }) => severity == Severity::Note,
            _ => false,
        };
        assert!(source.diagnostics.iter().any(is_reason), "{clip}: {:?}", source.diagnostics);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn transitions_between_standing_and_walking_are_no_examples() {
    let folder = mocap().join("smartbody_converted");
    let clips = ["StepBackwardsRt01", "StepForwardRt01", "StepSidewaysRt01", "Idle01_ToWalk01", "Walk01_ToIdle01"];
    let files = clip_files(&folder).unwrap();
    check_none(&files, &clips, Severity::Note);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn what_is_no_gait_is_no_example() {
    let folder = mocap().join("gltf");
    let files = clip_files(&folder).unwrap();
    let clips = ["Dance", "Death", "Jump", "Punch", "Sitting", "Crawling", "Crouching", "Dodge_Left", "TPose"];
    check_none(&files, &clips, Severity::NoExample);
}

//! Claims about the import: clips of others, and files written here.
//!
//! The parameters of clips of others are compared with independent measurements in the tests of `fbcrowd-bench`.

mod support;

use std::fs;
use std::path::Path;

use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Unfit};
use motiondb_compiler::{HumanClip, ImportedClip, Rejection, RejectionReason, clip_files, import_bytes, import_file};
use support::mocap;

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn clips_that_are_not_human_are_rejected_with_reasons() {
    let folder = mocap();
    for animation in import_file(&folder.join("gltf/Fox.glb")).unwrap() {
        assert!(
            matches!(animation.outcome, Err(RejectionReason::NotUpright { .. })),
            "{}: {:?}",
            animation.clip,
            animation.outcome.map(|human| human.source)
        );
    }
    for toy in ["bvh_anim_test_simple.bvh", "rotation_first_root.bvh"] {
        let imports = import_file(&folder.join("quirks").join(toy)).unwrap();
        assert!(matches!(imports[0].outcome, Err(RejectionReason::NoLegs)), "{toy}");
    }
    let arm = import_file(&folder.join("quirks/arm_no_newline.bvh")).unwrap();
    assert!(matches!(arm[0].outcome, Err(RejectionReason::TooShort)));
    for (file, place) in [("no_frames_header.bvh", "line "), ("no_motion_section_b.bvh", "line 185")] {
        let message = import_file(&folder.join("quirks").join(file)).unwrap_err().to_string();
        assert!(message.contains(file) && message.contains(place), "{message}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn wrong_frame_times_and_first_poses_are_reported() {
    let folder = mocap();
    let slow = import_file(&folder.join("quirks/02_03_wrong_frame_time.bvh")).unwrap().remove(0).outcome.unwrap();
    assert!(matches!(slow.unfit, Some(Unfit::InhumanGait { .. })), "{:?}", slow.unfit);
    assert_eq!((slow.first_frame, slow.frames.len()), (4, 170), "{:?}", slow.source.diagnostics);
    let blended = import_file(&folder.join("pfnn/LocomotionFlat04_000.bvh")).unwrap().remove(0).outcome.unwrap();
    let is_cut = |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::TPoseCut { end: ClipEnd::First, .. }));
    assert!(blended.source.diagnostics.iter().any(is_cut), "{:?}", blended.source.diagnostics);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn nameless_skeletons_are_understood_by_their_shape() {
    let folder = mocap();
    for file in [
        "smartbody_converted/ChrMarine_Walk01.bvh",
        "smartbody_converted/ChrMarine_StrafeFastRt01.bvh",
        "lafan1_skeleton/egg_walking.bvh",
        "games105/walkF.bvh",
        "cmu_motionviewer/walk.bvh",
    ] {
        let path = folder.join(file);
        let text = String::from_utf8(std::fs::read(&path).unwrap()).unwrap();
        let mut count = 0;
        let nameless: Vec<String> = text
            .lines()
            .map(|line| match line.split_whitespace().next() {
                Some(keyword @ ("ROOT" | "JOINT")) => {
                    count += 1;
                    format!("{keyword} n{count}")
                }
                _ => line.to_owned(),
            })
            .collect();
        let named = import_file(&path).unwrap().remove(0).outcome.unwrap();
        let found = import_bytes(&path, nameless.join("\n").as_bytes()).unwrap().remove(0).outcome.unwrap();
        let [named, found] = [named, found].map(|clip| (clip.source.speed_mps, clip.source.turn_rate_rad_s));
        assert!(
            (named.0 - found.0).abs() < 0.03 && (named.1 - found.1).abs() < 0.06,
            "{file}: {found:?}, not {named:?}"
        );
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn folders_list_their_clips_in_order() {
    let folder = mocap();
    let files = clip_files(&folder).unwrap();
    assert!(files.is_sorted() && files.len() > 80);
    assert!(files.iter().all(|file| ["bvh", "glb"].contains(&file.extension().unwrap().to_str().unwrap())));
}

#[test]
fn hidden_files_are_not_clips() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hidden_files_are_not_clips");
    for name in ["walk.bvh", "._walk.bvh", ".hidden/run.bvh", "__MACOSX/._walk.bvh", "sub/jog.glb"] {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "").unwrap();
    }
    let named = ["sub/jog.glb", "walk.bvh"].map(|name| folder.join(name));
    assert_eq!(clip_files(&folder).unwrap(), named);
}

fn only(imports: Result<Vec<ImportedClip>, Rejection>) -> HumanClip {
    imports.unwrap_or_else(|error| panic!("{error}")).remove(0).outcome.unwrap_or_else(|reason| panic!("{reason}"))
}

#[path = "import/doubtful.rs"]
mod doubtful;
#[path = "import/written.rs"]
mod written;
#[path = "import/written_body.rs"]
mod written_body;

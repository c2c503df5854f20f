//! Claims about the import: real clips made by others against their independently measured truth, and hand-written
//! files against malice.
//!
//! The real clips are test input only and lie outside the repository (`../shared/mocap` beside it, truth in its
//! `index.csv`); tests that need them say SKIPPED and pass where they are missing.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Unfit};
use motiondb_compiler::read::{SourceClip, bvh, gltf};
use motiondb_compiler::retarget::units;
use motiondb_compiler::rig::find_roles;
use motiondb_compiler::truth::{self, Truth};
use motiondb_compiler::{HumanClip, ImportedClip, Rejection, RejectionReason, clip_files, import_bytes, import_file};

const MOCAP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/mocap");

fn mocap(test: &str) -> Option<PathBuf> {
    let folder = Path::new(MOCAP);
    if !folder.is_dir() {
        println!("SKIPPED {test}: {MOCAP} is missing");
        return None;
    }
    Some(folder.to_owned())
}

fn locomotion(folder: &Path) -> Vec<Truth> {
    truth::read(folder).unwrap()
}

fn imported(folder: &Path, row: &Truth) -> HumanClip {
    let imports = import_file(&folder.join(&row.file)).unwrap_or_else(|error| panic!("{error}"));
    let found = imports.into_iter().find(|import| import.clip == row.clip).expect("the clip is in the file");
    found.outcome.unwrap_or_else(|reason| panic!("{} {}: {reason}", row.file, row.clip))
}

fn source(path: &Path, clip: &str) -> SourceClip {
    let bytes = std::fs::read(path).unwrap();
    let clips = match path.extension().unwrap().to_str().unwrap() {
        "bvh" => vec![bvh::read(path, &bytes).unwrap()],
        _ => gltf::read(path, &bytes).unwrap(),
    };
    clips.into_iter().find(|source| source.clip == clip).unwrap()
}

/// The differences of one clip where they exceed the tolerances of [`truth`].
fn misses(folder: &Path, row: &Truth) -> Option<String> {
    let judgement = row.judge(&imported(folder, row));
    let is_off = judgement.is_judged && !judgement.holds();
    (is_off || !judgement.units_hold).then(|| format!("{} {}: {judgement:.3?}", row.file, row.clip))
}

#[test]
fn every_locomotion_clip_imports_with_its_measured_parameters_axes_and_units() {
    let Some(folder) = mocap("every_locomotion_clip_imports_with_its_measured_parameters_axes_and_units") else {
        return;
    };
    let rows = locomotion(&folder);
    let missed: Vec<String> = rows.iter().filter_map(|row| misses(&folder, row)).collect();
    assert!(rows.len() >= 80 && missed.is_empty(), "{} of {}:\n{}", missed.len(), rows.len(), missed.join("\n"));
}

#[test]
fn what_is_no_human_motion_is_refused_by_name_and_reason() {
    let Some(folder) = mocap("what_is_no_human_motion_is_refused_by_name_and_reason") else { return };
    for animation in import_file(&folder.join("gltf/Fox.glb")).unwrap() {
        assert!(
            matches!(animation.outcome, Err(RejectionReason::NotUpright { .. } | RejectionReason::MovesLengthwise)),
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
fn a_lying_frame_time_and_a_separate_first_pose_are_told() {
    let Some(folder) = mocap("a_lying_frame_time_and_a_separate_first_pose_are_told") else { return };
    let slow = import_file(&folder.join("quirks/02_03_wrong_frame_time.bvh")).unwrap().remove(0).outcome.unwrap();
    assert!(matches!(slow.unfit, Some(Unfit::InhumanGait { .. })), "{:?}", slow.unfit);
    assert_eq!((slow.first_frame, slow.frames.len()), (4, 170), "{:?}", slow.source.diagnostics);
    let blended = import_file(&folder.join("pfnn/LocomotionFlat04_000.bvh")).unwrap().remove(0).outcome.unwrap();
    let is_cut = |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::TPoseCut { end: ClipEnd::First, .. }));
    assert!(blended.source.diagnostics.iter().any(is_cut), "{:?}", blended.source.diagnostics);
    for row in locomotion(&folder) {
        assert_eq!(imported(&folder, &row).unfit, None, "{}", row.file);
    }
}

/// Greatest distance between a canonical joint and its source joint, both seen from the hips, metres.
fn farthest_off(path: &Path, clip: &str, human: &HumanClip, joints: &[Joint]) -> f64 {
    let clip = source(path, clip);
    let roles = find_roles(&clip, &[None; JOINT_COUNT]).unwrap();
    let (clip, _) = units::to_metres_z_up(clip, &roles);
    let dropped = clip.frame_count() - human.frames.len();
    let mut farthest: f64 = 0.0;
    for (frame, pose) in human.frames.iter().enumerate() {
        let posed = pose.forward_kinematics(&human.body);
        let source = |joint: Joint| roles.joints[joint.index()].map(|joint| clip.position(frame + dropped, joint));
        let hips = 0.5 * Joint::THIGHS.map(|hip| source(hip).unwrap()).into_iter().sum::<DVec3>();
        for &joint in joints {
            let Some(wanted) = source(joint) else { continue };
            farthest = farthest.max((posed.positions_m[joint.index()] - pose.pelvis_m - (wanted - hips)).length());
        }
    }
    farthest
}

/// Greatest distances of hips, of knees and ankles, and of head, shoulders and hands, metres. Rigid skeletons are met
/// to the millimetre. In CMU's the hips turn about helpers within the pelvis; drawn characters stretch; `ezgi_walk1`
/// translates its knees: there the mean body cannot follow the bones' lengths, but knees and ankles are aimed at all
/// the same.
fn distance_limits(file: &str) -> [f64; 3] {
    match file.split('/').next().unwrap() {
        "cmu_cgspeed" | "xia" => [3e-3, 1e-3, 5e-3],
        "pfnn" => [0.03, 3e-3, 0.06],
        "gltf" if file.contains("kaykit") => [0.02, 6e-3, 0.02],
        "gltf" if file.contains("Robot") => [1e-3, 0.06, 0.01],
        "misc" => [3e-3, 0.04, 5e-3],
        _ => [1e-3, 1e-3, 5e-3],
    }
}

#[test]
fn retargeted_joints_stand_where_the_sources_do() {
    let Some(folder) = mocap("retargeted_joints_stand_where_the_sources_do") else { return };
    let legs = [Joint::SHANKS, Joint::FEET].concat();
    let upper = [Joint::Head, Joint::LeftUpperArm, Joint::RightUpperArm, Joint::LeftHand, Joint::RightHand];
    for row in locomotion(&folder) {
        let human = imported(&folder, &row);
        let path = folder.join(&row.file);
        let groups: [&[Joint]; 3] = [&Joint::THIGHS, &legs, &upper];
        let off = groups.map(|joints| farthest_off(&path, &row.clip, &human, joints));
        let limits = distance_limits(&row.file);
        assert!((0..3).all(|group| off[group] < limits[group]), "{} {}: {off:?} m", row.file, row.clip);
    }
}

#[test]
fn knees_and_elbows_flex_feet_stand_flat_and_bodies_upright() {
    let Some(folder) = mocap("knees_and_elbows_flex_feet_stand_flat_and_bodies_upright") else { return };
    for row in locomotion(&folder) {
        let human = imported(&folder, &row);
        let name = format!("{} {}", row.file, row.clip);
        let mean =
            |value: &dyn Fn(usize) -> f64| (0..human.frames.len()).map(value).sum::<f64>() / human.frames.len() as f64;
        let turn = |frame: usize, joint: Joint| human.frames[frame].rotations[joint.index()].to_scaled_axis();
        for side in 0..2 {
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let forearm = [Joint::LeftForearm, Joint::RightForearm][side];
            let (knee, elbow) =
                (mean(&|frame| turn(frame, Joint::SHANKS[side]).y), mean(&|frame| -sign * turn(frame, forearm).z));
            // A body may stand on straight knees: the left knee of games105/idle bends back by 0.4°.
            let knee_min = if human.source.speed_mps.abs() < 0.1 { -0.01 } else { 0.01 };
            assert!(knee > knee_min && elbow > 0.0, "{name}: {knee} {elbow}");
        }
        let posed: Vec<_> = human.frames.iter().map(|pose| pose.forward_kinematics(&human.body)).collect();
        let upright = mean(&|frame| (posed[frame].orientations[Joint::Head.index()] * DVec3::Z).z);
        let hips = mean(&|frame| (posed[frame].orientations[Joint::Pelvis.index()] * DVec3::Z).z);
        assert!(upright > 0.9 && hips > 0.8, "{name}: {upright} {hips}");
        let scale = human.body.offsets_m[Joint::LeftShank.index()].length() / 0.42;
        for side in 0..2 {
            let mut lowest: Vec<f64> = posed
                .iter()
                .map(|joints| {
                    joints.sole_points_m(&human.body, side).iter().map(|point| point.z).fold(f64::MAX, f64::min)
                })
                .collect();
            lowest.sort_by(f64::total_cmp);
            let planted = lowest[lowest.len() / 10];
            assert!(planted.abs() < 0.03 * scale, "{name}: sole at {planted}");
        }
    }
}

#[test]
fn nameless_skeletons_are_understood_by_their_shape() {
    let Some(folder) = mocap("nameless_skeletons_are_understood_by_their_shape") else { return };
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
fn folders_list_their_clips_in_order() {
    let Some(folder) = mocap("folders_list_their_clips_in_order") else { return };
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
#[path = "import/on_the_spot.rs"]
mod on_the_spot;
#[path = "import/written.rs"]
mod written;

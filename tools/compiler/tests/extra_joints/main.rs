//! Claims about joints beside the 22 roles, on bundled clips with made-up hands.

mod hands;

use std::f64::consts::TAU;
use std::path::Path;

use glam::{DQuat, Quat};
use hands::{Bone, FINGERS, both, bundled, fingers, text_with_hands, with_joints};
use motiondb::body::{ExtraJoint, Joint, Side};
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::files::database_file;
use motiondb::motion::{ExtraMotion, MotionDb, PHASE_COUNT};
use motiondb::validate::first_broken;
use motiondb_compiler::{HumanClip, Options, compile, import_bytes};

/// Greatest error of an angle, degrees.
const ERROR_MAX_DEG: f64 = 0.5;

/// The clip of a BVH text.
fn imported(name: &str, text: &str) -> HumanClip {
    import_bytes(Path::new(&format!("{name}.bvh")), text.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

/// A bundled clip whose hands, `[left, right]`, have these joints.
fn clip_with_hands(name: &str, hands: &[Vec<Bone>; 2]) -> HumanClip {
    imported(name, &text_with_hands(name, hands))
}

/// The canonical rotation of a finger's joint that curls.
fn curled(side: Side, curl_deg: f64) -> DQuat {
    DQuat::from_rotation_x((-f64::from(side.sign()) * curl_deg).to_radians())
}

#[track_caller]
fn check_angle(found: DQuat, wanted: DQuat, what: &str) {
    let error_deg = found.angle_between(wanted).to_degrees();
    assert!(error_deg < ERROR_MAX_DEG, "{what}: off by {error_deg}°");
}

/// Checks the rotation of a joint in a row of an example.
#[track_caller]
fn check_row(db: &MotionDb, example: &str, row: usize, joint: ExtraJoint, wanted: DQuat) {
    let index = db.examples.iter().position(|other| other.name == example).unwrap();
    let found = db.extra.row(index, row)[db.extra.position(joint).unwrap()].as_dquat();
    check_angle(found, wanted, &format!("{example}, row {row}, {}", joint.name()));
}

fn database(clips: Vec<HumanClip>) -> MotionDb {
    let db = compile(clips, &Options::default(), &|_| ()).unwrap();
    assert_eq!(first_broken(&db), None);
    db
}

#[test]
fn a_curl_comes_through_in_every_frame() {
    let curl_deg = |finger: usize, time_s: f64| 10.0 * finger as f64 + 20.0 + 15.0 * libm::sin(TAU * time_s);
    let clip = clip_with_hands("walk_110", &both(curl_deg));
    assert_eq!(clip.extra.len(), 30);
    for (frame, pose) in clip.frames.iter().enumerate() {
        for (extra, found) in clip.extra.iter().zip(&pose.extra) {
            let (finger, side) = (extra.joint.index() / 6, extra.joint.side());
            let time_s = (clip.first_frame + frame) as f64 / clip.frame_rate_hz;
            if finger > 0 {
                check_angle(*found, curled(side, curl_deg(finger, time_s)), &extra.joint.name());
            }
        }
    }
}

#[test]
fn curled_bones_of_a_rig_are_a_curl() {
    let mut hands = both(|_, _| 0.0);
    for (side, bones) in Side::BOTH.into_iter().zip(&mut hands) {
        let curl_rad = 25_f64.to_radians();
        // Of each finger the second bone points down in the rig's zero pose, the third in line with it.
        for finger in &mut bones[1..] {
            let along = 3.5 * f64::from(side.sign()) * libm::cos(curl_rad);
            let middle = &mut finger.children[0];
            middle.children[0].offset_cm = [along, -3.5 * libm::sin(curl_rad), 0.0];
        }
    }
    let clip = clip_with_hands("walk_110", &hands);
    for (extra, found) in clip.extra.iter().zip(&clip.frames[0].extra).skip(6) {
        let wanted = if extra.joint.index() / 2 % 3 == 1 { 25.0 } else { 0.0 };
        check_angle(*found, curled(extra.joint.side(), wanted), &extra.joint.name());
    }
}

/// CMU's skeletons: a finger that stands for all, and a thumb without a bone.
#[test]
fn a_hand_of_one_finger_has_none() {
    let bone = |name: &str, x_cm: f64| Bone {
        name: name.into(),
        offset_cm: [x_cm, 0.0, 0.0],
        axis: 'Z',
        turn_deg: Box::new(|time_s| 10.0 * libm::sin(TAU * time_s)),
        children: Vec::new(),
    };
    let mut hands = [vec![bone("LeftHandIndex1", 9.0), bone("LThumb", 0.0)], Vec::new()];
    let clip = clip_with_hands("walk_110", &hands);
    assert!(clip.extra.is_empty(), "{:?}", clip.extra);
    let left_out = Diagnostic::Note(Note::JointsLeftOut { moving: 2, kept: 0 });
    assert!(clip.source.diagnostics.contains(&left_out), "{:?}", clip.source.diagnostics);
    hands[0].push(bone("LeftHandPinky1", 8.0));
    let names = |clip: &HumanClip| clip.extra.iter().map(|extra| extra.joint.name()).collect::<Vec<_>>();
    assert_eq!(names(&clip_with_hands("walk_110", &hands)), ["left_index_1", "left_little_1"]);
}

/// The knuckles spread, the next joints curl: their hinges are those of the fingers, not of the palm.
#[test]
fn spread_fingers_curl_about_their_own_hinges() {
    let mut hands = both(|_, _| 0.0);
    for (side, bones) in Side::BOTH.into_iter().zip(&mut hands) {
        let sign = f64::from(side.sign());
        for finger in &mut bones[1..] {
            (finger.axis, finger.turn_deg) = ('Y', Box::new(|_| 20.0));
            finger.children[0].turn_deg = Box::new(move |time_s| -sign * (50.0 + 30.0 * libm::sin(TAU * time_s)));
        }
    }
    let clip = clip_with_hands("walk_110", &hands);
    for (frame, pose) in clip.frames.iter().enumerate() {
        let time_s = (clip.first_frame + frame) as f64 / clip.frame_rate_hz;
        let second = |joint: ExtraJoint| joint.index() / 2 % 3 == 1;
        for (extra, found) in clip.extra.iter().zip(&pose.extra).skip(6).filter(|(extra, _)| second(extra.joint)) {
            let wanted = curled(extra.joint.side(), 50.0 + 30.0 * libm::sin(TAU * time_s));
            check_angle(*found, wanted, &extra.joint.name());
        }
    }
}

#[test]
fn mirrored_examples_have_the_other_hand() {
    let hands = [fingers(Side::Left, |finger, _| 10.0 * finger as f64), fingers(Side::Right, |_, _| 5.0)];
    let db = database(vec![clip_with_hands("turn_060_left", &hands), clip_with_hands("walk_110", &both(|_, _| 30.0))]);
    for (example, curls_deg) in [("turn_060_left", [40.0, 5.0]), ("turn_060_left_mirrored", [5.0, 40.0])] {
        for (side, curl_deg) in Side::BOTH.into_iter().zip(curls_deg) {
            (0..PHASE_COUNT)
                .for_each(|row| check_row(&db, example, row, ExtraJoint::finger(side, 4, 1), curled(side, curl_deg)));
        }
    }
    let bytes = database_file::to_bytes(&db);
    assert_eq!(database_file::from_bytes(Path::new("kept"), &bytes).unwrap().0, db);
}

#[test]
fn clips_without_fingers_hold_the_mean() {
    let none = [Vec::new(), Vec::new()];
    let one = [fingers(Side::Left, |_, _| 20.0), Vec::new()];
    let clips = || vec![clip_with_hands("walk_110", &both(|_, _| 40.0)), clip_with_hands("run_350", &one)];
    let mut with_bare = clips();
    with_bare.extend(["walk_050", "idle"].map(|name| clip_with_hands(name, &none)));
    let db = database(with_bare);
    for (example, side, curl_deg) in
        [("walk_050", Side::Left, 30.0), ("walk_050", Side::Right, 40.0), ("run_350", Side::Right, 40.0)]
    {
        check_row(&db, example, 9, ExtraJoint::finger(side, 2, 0), curled(side, curl_deg));
    }
    let joint = db.extra.position(ExtraJoint::finger(Side::Left, 2, 0)).unwrap();
    for frame in 0..db.actions[0].frames.len() {
        check_angle(db.extra.frame(0, frame)[joint].as_dquat(), curled(Side::Left, 30.0), "idle");
    }
    let bare = database(vec![clip_with_hands("walk_110", &none)]);
    assert_eq!(bare.extra, ExtraMotion::default());
    assert_eq!(database_file::to_bytes(&bare)[8], 3);
}

/// Least and greatest angle of some rotations, degrees.
fn angles_deg(turns: impl Iterator<Item = Quat>) -> [f32; 2] {
    let angles = turns.map(|turn| turn.angle_between(Quat::IDENTITY).to_degrees());
    angles.fold([f32::MAX, 0.0], |[least, greatest], angle| [least.min(angle), greatest.max(angle)])
}

#[test]
fn fingers_move_as_in_strides_and_idles() {
    // A stride, and a fifth of the idle.
    const STRIDE_S: f64 = 1.208_333;
    const SWAY_S: f64 = 1.2;
    let in_stride = |_: usize, time_s: f64| 30.0 + 20.0 * libm::sin(TAU * time_s / STRIDE_S);
    let in_sway = |_: usize, time_s: f64| 30.0 + 20.0 * libm::sin(TAU * time_s / SWAY_S);
    let db = database(vec![
        clip_with_hands("walk_110", &[fingers(Side::Left, in_stride), Vec::new()]),
        clip_with_hands("idle", &[fingers(Side::Left, in_sway), Vec::new()]),
    ]);
    let walk = db.examples.iter().position(|example| example.name == "walk_110").unwrap();
    assert!((f64::from(db.examples[walk].phase_map.period_s) - STRIDE_S).abs() < 1e-3);
    let joint = db.extra.position(ExtraJoint::finger(Side::Left, 1, 0)).unwrap();
    let rows = angles_deg((0..PHASE_COUNT).map(|row| db.extra.row(walk, row)[joint]));
    let frames = angles_deg((0..db.actions[0].frames.len()).map(|frame| db.extra.frame(0, frame)[joint]));
    for (name, [least, greatest]) in [("walk_110", rows), ("idle", frames)] {
        assert!((least - 10.0).abs() < 0.5 && (greatest - 50.0).abs() < 0.5, "{name}: {least}° to {greatest}°");
    }
}

/// Each hand has 500 joints that move, 100 in a row for each finger.
#[test]
fn hands_of_500_joints_are_bounded_and_reported() {
    let finger = |side: Side, finger: usize| {
        let sign = f64::from(side.sign());
        let mut bones = Vec::new();
        for joint in (0..100).rev() {
            bones = vec![Bone {
                name: format!("{}{}{}", ["Left", "Right"][side.index()], FINGERS[finger], joint + 1),
                offset_cm: if joint == 0 { [sign * 9.0, 0.0, finger as f64] } else { [sign * 0.05, 0.0, 0.0] },
                axis: 'Z',
                turn_deg: Box::new(|time_s| 3.0 * libm::sin(TAU * time_s)),
                children: bones,
            }];
        }
        bones.remove(0)
    };
    let hands = Side::BOTH.map(|side| (0..5).map(|index| finger(side, index)).collect::<Vec<Bone>>());
    let clip = clip_with_hands("walk_110", &hands);
    assert_eq!(clip.extra.len(), 30);
    let note = Diagnostic::Note(Note::JointsLeftOut { moving: 970, kept: 30 });
    assert!(clip.source.diagnostics.contains(&note), "{:?}", clip.source.diagnostics);
}

/// A twist bone between knee and ankle is relative to the shank.
#[test]
fn twist_bones_turn_about_their_limbs() {
    let twist_deg = |time_s: f64| 20.0 * libm::sin(TAU * time_s);
    let bone = Bone {
        name: "LeftLegTwist".into(),
        offset_cm: [0.0, -20.0, 0.0],
        axis: 'Y',
        turn_deg: Box::new(twist_deg),
        children: Vec::new(),
    };
    let text = bundled("walk_110");
    let clip = imported("twist", &with_joints(&text, text.find("JOINT LeftFoot").unwrap(), &[bone]));
    assert_eq!(clip.extra.len(), 1);
    assert_eq!(clip.extra[0].joint, ExtraJoint::twist(Joint::LeftShank).unwrap());
    for (frame, pose) in clip.frames.iter().enumerate() {
        let time_s = (clip.first_frame + frame) as f64 / clip.frame_rate_hz;
        let error_deg =
            pose.extra[0].angle_between(DQuat::from_rotation_z(twist_deg(time_s).to_radians())).to_degrees();
        assert!(error_deg < 1.5, "frame {frame}: {error_deg}°");
    }
}

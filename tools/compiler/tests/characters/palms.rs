//! Hands of a figure that wears its own clip: turned as in the clip, however the palms are bound.

use std::f32::consts::TAU;
use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{ExtraJoint, Joint, Pose, RootFrame, Side, Skeleton};
use motiondb::character::{Character, CharacterFit, JointTransform};
use motiondb_compiler::{HumanClip, import_bytes};
use serde_json::json;

use crate::figure::{Figure, glb};
use crate::support::{compiled, skeleton};

/// Frame rate of the clip, Hz.
const RATE_HZ: f32 = 30.0;
/// Number of frames of the clip: four strides.
const FRAMES: usize = 144;
/// Greatest error of a hand's orientation, degrees.
const ERROR_MAX_DEG: f32 = 1.0;

/// Turns the joints below one about it, in the bind pose.
fn turn_below(figure: &mut Figure, top: &str, turn: Quat) {
    let top = figure.bones.iter().position(|bone| bone.0 == top).unwrap();
    let centre_m = Vec3::from(figure.bones[top].2);
    let is_below = |figure: &Figure, joint: usize| {
        std::iter::successors(figure.bones[joint].1, |&at| figure.bones[at].1).any(|at| at == top)
    };
    for joint in 0..figure.bones.len() {
        if is_below(figure, joint) {
            let position_m = Vec3::from(figure.bones[joint].2);
            figure.bones[joint].2 = (centre_m + turn * (position_m - centre_m)).to_array();
        }
    }
}

/// An adult with fingers, palms turned up from facing down, elbows bent forward.
fn figure(palm_deg: f32, elbow_deg: f32) -> Figure {
    let mut figure = Figure::adult().with_fingers();
    for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
        turn_below(&mut figure, &format!("{side}Hand"), Quat::from_rotation_x(-palm_deg.to_radians()));
        let bend = Quat::from_rotation_y(-sign * elbow_deg.to_radians());
        turn_below(&mut figure, &format!("{side}ForeArm"), bend);
    }
    figure
}

/// Local rotation of a joint of a figure that walks in place with hanging arms; file axes.
fn local(figure: &Figure, joint: usize, time_s: f32) -> Quat {
    let name = figure.bones[joint].0;
    let is_left = name.starts_with("Left");
    let sign = if is_left { 1.0 } else { -1.0 };
    let swing = sign * libm::sinf(TAU * time_s / 1.2);
    let degrees = |angle: f32| angle.to_radians();
    match name.trim_start_matches("Left").trim_start_matches("Right") {
        "UpLeg" => Quat::from_rotation_x(degrees(-25.0 * swing)),
        "Leg" => Quat::from_rotation_x(degrees(20.0 - 10.0 * swing)),
        "Arm" => Quat::from_rotation_x(degrees(20.0 * swing)) * Quat::from_rotation_z(degrees(-75.0 * sign)),
        "ForeArm" => Quat::from_rotation_y(degrees(-sign * (30.0 + 15.0 * swing))),
        // Forearms twist, and wrists bend.
        "Hand" => Quat::from_rotation_x(degrees(20.0 + 10.0 * swing)) * Quat::from_rotation_z(degrees(8.0 * swing)),
        _ => Quat::IDENTITY,
    }
}

/// The figure's file with the walk.
fn with_walk(figure: &Figure) -> Vec<u8> {
    let (mut json, mut bytes) = figure.document();
    let mut add = |json: &mut serde_json::Value, values: Vec<f32>, count: usize, kind: &str| {
        let start = bytes.len();
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let views = json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() - start }));
        let view = views.len() - 1;
        let mut accessor = json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
        if kind == "SCALAR" {
            (accessor["min"], accessor["max"]) = (json!([values[0]]), json!([values[count - 1]]));
        }
        let accessors = json["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    };
    let times_s: Vec<f32> = (0..FRAMES).map(|frame| frame as f32 / RATE_HZ).collect();
    let input = add(&mut json, times_s.clone(), FRAMES, "SCALAR");
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for joint in 0..figure.bones.len() {
        let turns = times_s.iter().flat_map(|&time_s| local(figure, joint, time_s).to_array()).collect();
        let output = add(&mut json, turns, FRAMES, "VEC4");
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": joint, "path": "rotation" } }));
        samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }
    json["animations"] = json!([{ "name": "walk", "samplers": samplers, "channels": channels }]);
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    glb(&json, &bytes)
}

/// Rotation from bind of a joint in the file, body axes (x forward, y left, z up).
fn rotation(figure: &Figure, name: &str, time_s: f32) -> Quat {
    let joint = figure.bones.iter().position(|bone| bone.0 == name).unwrap();
    let chain: Vec<usize> = std::iter::successors(Some(joint), |&at| figure.bones[at].1).collect();
    let turn = chain.iter().rev().fold(Quat::IDENTITY, |turn, &joint| turn * local(figure, joint, time_s));
    Quat::from_xyzw(turn.z, turn.x, turn.y, turn.w)
}

/// The transforms of a character that wears a frame of a clip, root frame.
fn worn(character: &Character, clip: &HumanClip, frame: usize) -> Vec<JointTransform> {
    let skeleton = Skeleton { offsets_m: clip.body.offsets_m.map(|offset_m| offset_m.as_vec3()), ..skeleton() };
    let source = &clip.frames[frame];
    let pose =
        Pose { pelvis_m: source.pelvis_m.as_vec3(), rotations: source.rotations.map(|rotation| rotation.as_quat()) };
    let fit = CharacterFit::new(character, &skeleton);
    let root = RootFrame { position_m: Vec2::ZERO, forward: Vec2::X };
    let mut transforms = Vec::new();
    fit.pose(&skeleton, &pose.forward_kinematics(&skeleton), root, &mut transforms);
    let position = |joint: ExtraJoint| clip.extra.iter().position(|extra| extra.joint == joint);
    fit.pose_extra(|joint| position(joint).map(|at| source.extra[at].as_quat()), &mut transforms);
    transforms
}

/// Checks that hands and fingers of a figure that wears its own clip are turned as in the clip.
#[track_caller]
fn check_own_hands(palm_deg: f32, elbow_deg: f32) {
    let figure = figure(palm_deg, elbow_deg);
    let bytes = with_walk(&figure);
    let character = compiled(&bytes).character;
    let clip = import_bytes(Path::new("figure.glb"), &bytes).unwrap().remove(0).outcome.unwrap();
    for frame in (0..clip.frames.len()).step_by(5) {
        let time_s = (clip.first_frame + frame) as f32 / clip.frame_rate_hz as f32;
        let transforms = worn(&character, &clip, frame);
        let pelvis = transforms[character.joint(Joint::Pelvis).unwrap()].rotation;
        for side in Side::BOTH {
            let word = ["Left", "Right"][side.index()];
            let hand = character.joint([Joint::LeftHand, Joint::RightHand][side.index()]).unwrap();
            let finger = character.extra_joint(ExtraJoint::finger(side, 2, 1)).unwrap();
            let wanted = rotation(&figure, &format!("{word}Hand"), time_s);
            for joint in [hand, finger] {
                let found = pelvis.conjugate() * transforms[joint].rotation;
                let error_deg = found.angle_between(wanted).to_degrees();
                let name = &character.joints[joint].name;
                assert!(
                    error_deg < ERROR_MAX_DEG,
                    "palms {palm_deg}°, elbows {elbow_deg}°: {name} at {time_s} s is {error_deg}° off"
                );
            }
        }
    }
}

#[test]
fn own_hands_come_back_however_palms_are_bound() {
    for palm_deg in [0.0, 45.0, 90.0] {
        for elbow_deg in [0.0, 40.0] {
            check_own_hands(palm_deg, elbow_deg);
        }
    }
}

/// Palms that are bound facing forward face down at the skeleton's rest.
#[test]
fn palms_face_down_at_rest() {
    let skeleton = skeleton();
    for (palm_deg, elbow_deg) in [(0.0, 0.0), (90.0, 0.0), (90.0, 40.0)] {
        let character = compiled(&figure(palm_deg, elbow_deg).glb()).character;
        let fit = CharacterFit::new(&character, &skeleton);
        let mut transforms = Vec::new();
        let joints = crate::support::rest(&skeleton).forward_kinematics(&skeleton);
        fit.pose(&skeleton, &joints, RootFrame { position_m: Vec2::ZERO, forward: Vec2::X }, &mut transforms);
        for side in Side::BOTH {
            let at_m = |finger: usize| {
                let joint = character.extra_joint(ExtraJoint::finger(side, finger, 0)).unwrap();
                transforms[joint].point_m(character.joints[joint].position_m)
            };
            let across = (at_m(1) - at_m(4)).normalize();
            assert!(across.dot(Vec3::X) > 0.9999, "palms {palm_deg}°, {side:?}: {across}");
        }
    }
}

//! What the tests of characters share: compiling, and posing on a skeleton.

use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, Joint, Joints, Pose, RootFrame, Skeleton};
use motiondb::character::{Character, CharacterFit};
use motiondb_compiler::character::{CharacterReason, CompiledCharacter, compile_character_bytes};
use serde_json::Value;

use crate::figure::glb;

#[track_caller]
pub(crate) fn compiled(bytes: &[u8]) -> CompiledCharacter {
    compile_character_bytes(Path::new("figure.glb"), bytes).unwrap_or_else(|rejection| panic!("{rejection}"))
}

pub(crate) fn reason(bytes: &[u8]) -> CharacterReason {
    compile_character_bytes(Path::new("figure.glb"), bytes).expect_err("it is no character").reason
}

#[track_caller]
pub(crate) fn check_rejected(json: &Value, bytes: &[u8], words: &str) {
    let text = reason(&glb(json, bytes)).to_string();
    assert!(text.contains(words), "{text}");
    assert!(text.contains("; "), "no remedy: {text}");
}

pub(crate) fn joint_name(character: &Character, role: Joint) -> &str {
    character.joint(role).map_or("", |joint| &character.joints[joint].name)
}

/// A skeleton with arms out along y, as a crowd's; hips 0.9 m over the soles.
pub(crate) fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::ZERO; JOINT_COUNT];
    let mut set = |joint: Joint, offset: [f32; 3]| offsets_m[joint.index()] = Vec3::from(offset);
    set(Joint::Pelvis, [0.0, 0.0, 0.95]);
    for (joint, height_m) in [(Joint::SpineLower, 0.1), (Joint::SpineMiddle, 0.1), (Joint::SpineUpper, 0.12)] {
        set(joint, [0.0, 0.0, height_m]);
    }
    set(Joint::Neck, [0.0, 0.0, 0.22]);
    set(Joint::Head, [0.0, 0.0, 0.1]);
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        set([Joint::LeftClavicle, Joint::RightClavicle][side], [0.0, 0.05 * sign, 0.15]);
        set(Joint::UPPER_ARMS[side], [0.0, 0.13 * sign, 0.0]);
        set([Joint::LeftForearm, Joint::RightForearm][side], [0.0, 0.28 * sign, 0.0]);
        set([Joint::LeftHand, Joint::RightHand][side], [0.0, 0.25 * sign, 0.0]);
        set(Joint::THIGHS[side], [0.0, 0.1 * sign, -0.05]);
        set(Joint::SHANKS[side], [0.0, 0.0, -0.42]);
        set(Joint::FEET[side], [0.0, 0.0, -0.41]);
        set(Joint::TOES[side], [0.14, 0.0, -0.05]);
    }
    let points = [Vec3::new(-0.05, 0.0, -0.07), Vec3::new(0.14, 0.0, -0.07), Vec3::new(0.07, 0.0, -0.02)];
    let foot = Foot { heel_m: points[0], ball_m: points[1], toe_tip_m: points[2], measured_m: points };
    Skeleton {
        segment_ends_m: offsets_m,
        offsets_m,
        segment_radii_m: [0.05; JOINT_COUNT],
        limits_rad: [[Vec3::splat(-3.0), Vec3::splat(3.0)]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

pub(crate) fn rest(skeleton: &Skeleton) -> Pose {
    Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] }
}

/// Positions of all vertices in a pose of the skeleton, facing x at the origin.
pub(crate) fn worn(character: &Character, joints: &Joints) -> Vec<Vec3> {
    let (skeleton, frame) = (skeleton(), RootFrame { position_m: Vec2::ZERO, forward: Vec2::X });
    let (mut transforms, mut positions_m, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    CharacterFit::new(character, &skeleton).pose(&skeleton, joints, frame, &mut transforms);
    character.mesh.skin(&transforms, &mut positions_m, &mut normals);
    assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    positions_m
}

pub(crate) fn worn_at_rest(character: &Character) -> Vec<Vec3> {
    worn(character, &rest(&skeleton()).forward_kinematics(&skeleton()))
}

pub(crate) fn bounds(positions_m: &[Vec3]) -> [Vec3; 2] {
    let bound = |pick: fn(Vec3, Vec3) -> Vec3| positions_m.iter().copied().reduce(pick).unwrap();
    [bound(Vec3::min), bound(Vec3::max)]
}

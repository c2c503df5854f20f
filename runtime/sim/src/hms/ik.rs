//! Two-bone leg IK: bends hip and knee so that the ankle meets a point, and turns the ankle so that the foot keeps its orientation.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres; orientations are against the rest pose. Analytic, by the law of
//! cosines; the leg stays in its plane, which turns with the line from hip to ankle, so the knee remains the hinge that the pose had.

use glam::{Mat3, Quat, Vec3};
use motiondb::pose::{Joints, Pose};
use motiondb::skeleton::{Joint, Skeleton};

/// Greatest share of the leg's length from hip to ankle: beyond it the knee angle changes infinitely fast (`motion.md` §2).
const EXTENSION_MAX: f32 = 0.999;
/// Least distance from hip to ankle, as a multiple of the bones' difference in length (`motion.md` §2).
const FLEXION_MARGIN: f32 = 1.001;
/// A straight leg has no plane; this much of the thigh's forward axis is added to the knee's offset, so that it bends forward, metres.
const KNEE_BIAS_M: f32 = 1e-3;

/// Where one foot shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootTarget {
    /// The ankle.
    pub ankle_m: Vec3,
    /// Of the foot joint; the toes keep their bend.
    pub orientation: Quat,
}

/// Moves one leg of `pose`, and of `joints` (its forward kinematics), to the target, or as near as the leg reaches.
pub fn reach(pose: &mut Pose, joints: &mut Joints, skeleton: &Skeleton, side: usize, target: &FootTarget) {
    let [thigh, shank, foot, toe] =
        [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side], Joint::TOES[side]].map(Joint::index);
    let [hip_m, knee_m, ankle_m] = [thigh, shank, foot].map(|joint| joints.positions_m[joint]);
    let bones_m = [skeleton.offsets_m[shank].length(), skeleton.offsets_m[foot].length()];

    let old_line = (ankle_m - hip_m).normalize_or(Vec3::NEG_Z);
    let new_line = (target.ankle_m - hip_m).normalize_or(old_line);
    let forward = joints.orientations[thigh] * Vec3::X;
    let old_pole = across(knee_m - hip_m + KNEE_BIAS_M * forward, old_line);
    let new_pole = across(Quat::from_rotation_arc(old_line, new_line) * old_pole, new_line);

    let (along_m, aside_m) = knee_offset_m(bones_m, (target.ankle_m - hip_m).length());
    let new_knee_m = hip_m + along_m * new_line + aside_m * new_pole;
    let new_ankle_m = hip_m + reachable_m(bones_m, (target.ankle_m - hip_m).length()) * new_line;

    let (old_normal, new_normal) = (old_line.cross(old_pole), new_line.cross(new_pole));
    let turn = |old_bone, new_bone| bone_turn((old_bone, old_normal), (new_bone, new_normal));
    let pelvis = joints.orientations[Joint::Pelvis.index()];
    let thigh_turned = (turn(knee_m - hip_m, new_knee_m - hip_m) * joints.orientations[thigh]).normalize();
    let shank_turned = (turn(ankle_m - knee_m, new_ankle_m - new_knee_m) * joints.orientations[shank]).normalize();

    pose.rotations[thigh] = pelvis.inverse() * thigh_turned;
    pose.rotations[shank] = thigh_turned.inverse() * shank_turned;
    pose.rotations[foot] = shank_turned.inverse() * target.orientation;
    joints.orientations[thigh] = thigh_turned;
    joints.orientations[shank] = shank_turned;
    joints.orientations[foot] = target.orientation;
    joints.orientations[toe] = target.orientation * pose.rotations[toe];
    joints.positions_m[shank] = hip_m + thigh_turned * skeleton.offsets_m[shank];
    joints.positions_m[foot] = joints.positions_m[shank] + shank_turned * skeleton.offsets_m[foot];
    joints.positions_m[toe] = joints.positions_m[foot] + target.orientation * skeleton.offsets_m[toe];
}

/// The distance from hip to ankle that a leg can have, nearest to the asked one.
fn reachable_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> f32 {
    let least_m = FLEXION_MARGIN * (thigh_m - shank_m).abs();
    distance_m.clamp(least_m, (EXTENSION_MAX * (thigh_m + shank_m)).max(least_m))
}

/// The knee along the line from hip to ankle, and aside of it, by the law of cosines.
fn knee_offset_m(bones_m: [f32; 2], distance_m: f32) -> (f32, f32) {
    let [thigh_m, shank_m] = bones_m;
    let distance_m = reachable_m(bones_m, distance_m).max(f32::EPSILON);
    let along_m = 0.5 * (distance_m + (thigh_m * thigh_m - shank_m * shank_m) / distance_m);
    (along_m, libm::sqrtf((thigh_m * thigh_m - along_m * along_m).max(0.0)))
}

/// The unit part of a vector across a unit line; any such direction where the vector lies along the line.
fn across(vector: Vec3, line: Vec3) -> Vec3 {
    (vector - line * vector.dot(line)).normalize_or(line.any_orthonormal_vector())
}

/// The rotation that takes one bone, and the normal of its leg's plane, to another.
fn bone_turn(old: (Vec3, Vec3), new: (Vec3, Vec3)) -> Quat {
    let frame = |(bone, normal): (Vec3, Vec3)| {
        let bone = bone.normalize_or(Vec3::NEG_Z);
        let normal = across(normal, bone);
        Mat3::from_cols(bone, normal, bone.cross(normal))
    };
    Quat::from_mat3(&(frame(new) * frame(old).transpose()))
}

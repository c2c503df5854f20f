//! Two-bone leg IK: bends hip and knee so that the ankle meets a point, and turns the ankle so that the foot keeps its
//! orientation.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres; orientations are against the rest pose.
//! Analytic, by the law of cosines; the leg stays in its plane, which turns with the line from hip to ankle, so the
//! knee remains the hinge that the pose had.

use std::f32::consts::PI;

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};

use crate::synthesis::pose::leg::{FootPose, Leg};

/// Greatest share of the leg's length from hip to ankle: a straight knee's angle changes infinitely fast.
const EXTENSION_MAX: f32 = 0.999;
/// Least distance from hip to ankle, as a multiple of the bones' difference in length: a folded one's does too.
const FLEXION_MARGIN: f32 = 1.001;
/// A straight leg has no plane, and what bends it bends it forward: its knee counts as this far before the line from
/// hip to ankle, m. With a millimetre, where what is left of a switch straightens a leg, the knee swings out aside.
const KNEE_AHEAD_M: f32 = 0.02;
/// 1 and the cosine of an angle, from which on two directions have no axis that rounding leaves: π − 1 mrad.
const OPPOSITE: f32 = 5e-7;

/// Moves one leg, and its joints in `pose`, to the target, or as near as it reaches.
///
/// In its own plane each bone turns from where it lies to where the law of cosines wants it; then the plane turns from
/// the old line between hip and ankle to the new one.
pub(crate) fn reach(pose: &mut Pose, leg: &mut Leg, skeleton: &Skeleton, side: usize, target: &FootPose) {
    let [thigh, shank, foot, _] = Leg::joints(side);
    let [hip_m, knee_m, ankle_m] = leg.positions_m;
    let [old_thigh, old_shank, ..] = leg.orientations;
    let (thigh_m, shank_m, line_m) = (knee_m - hip_m, ankle_m - knee_m, ankle_m - hip_m);
    let to_target_m = target.ankle_m - hip_m;

    let (line_length_m, target_length_m) = (line_m.length(), to_target_m.length());
    let line = if line_length_m > 0.0 { line_m / line_length_m } else { Vec3::NEG_Z };
    let distance_m = reachable_m(leg.bones_m, target_length_m);
    let (along_m, aside_m) = knee_offset_m(leg.bones_m, distance_m);
    let bent_thigh_m = along_m * line + aside_m * forward_pole(thigh_m, old_thigh * Vec3::X, line);
    let bent_shank_m = distance_m * line - bent_thigh_m;

    let swing = turn(line_m, to_target_m, line_length_m * target_length_m);
    let [thigh_length_m, shank_length_m] = leg.bones_m;
    let thigh_turned = (swing * turn(thigh_m, bent_thigh_m, thigh_length_m * thigh_length_m) * old_thigh).normalize();
    let shank_turned = (swing * turn(shank_m, bent_shank_m, shank_length_m * shank_length_m) * old_shank).normalize();

    pose.rotations[thigh] = pose.rotations[Joint::Pelvis.index()].conjugate() * thigh_turned;
    pose.rotations[shank] = thigh_turned.conjugate() * shank_turned;
    pose.rotations[foot] = shank_turned.conjugate() * target.orientation;
    let knee_m = hip_m + thigh_turned * skeleton.offsets_m[shank];
    let ankle_m = knee_m + shank_turned * skeleton.offsets_m[foot];
    leg.positions_m = [hip_m, knee_m, ankle_m];
    leg.orientations = [thigh_turned, shank_turned, target.orientation];
}

/// The distance from hip to ankle that a leg can have, nearest to the asked one.
fn reachable_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> f32 {
    let least_m = FLEXION_MARGIN * (thigh_m - shank_m).abs();
    distance_m.clamp(least_m, (EXTENSION_MAX * (thigh_m + shank_m)).max(least_m))
}

/// The knee along the line from hip to ankle, and aside of it, by the law of cosines.
fn knee_offset_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> (f32, f32) {
    let distance_m = distance_m.max(f32::EPSILON);
    let along_m = 0.5 * (distance_m + (thigh_m * thigh_m - shank_m * shank_m) / distance_m);
    (along_m, libm::sqrtf((thigh_m * thigh_m - along_m * along_m).max(0.0)))
}

/// The side of the line from hip to ankle to which the knee bends: that of the pose, but forward. A pose whose knee is
/// hyperextended (what is left of a switch may do that) has it behind the line, on the same hinge.
fn forward_pole(knee_m: Vec3, forward: Vec3, line: Vec3) -> Vec3 {
    let across = |vector: Vec3| vector - line * vector.dot(line);
    let forward = across(forward).try_normalize().unwrap_or_else(|| line.any_orthonormal_vector());
    let off_m = across(knee_m);
    let ahead_m = off_m.dot(forward);
    (off_m + (libm::sqrtf(ahead_m * ahead_m + KNEE_AHEAD_M * KNEE_AHEAD_M) - ahead_m) * forward).normalize()
}

/// The shortest rotation from the direction of one vector to that of another, of any length, given the product of both
/// lengths. Exact for the smallest angles, unlike what calls them nothing; for opposite vectors about any axis across,
/// for none at all none.
fn turn(from: Vec3, to: Vec3, lengths: f32) -> Quat {
    let (cross, one_and_cosine) = (from.cross(to), lengths + from.dot(to));
    if one_and_cosine > OPPOSITE * lengths {
        Quat::from_xyzw(cross.x, cross.y, cross.z, one_and_cosine)
    } else if lengths > 0.0 {
        Quat::from_axis_angle(from.normalize().any_orthonormal_vector(), PI)
    } else {
        Quat::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use motiondb::body::JOINT_COUNT;
    use proptest::prelude::*;

    use super::*;
    use crate::test_db::skeleton;

    /// A standing body with one knee bent by `bend_rad`, and the leg reached out to the target.
    fn reached(side: usize, bend_rad: f32, target: &FootPose) -> (Pose, Leg) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        pose.rotations[Joint::SHANKS[side].index()] = Quat::from_rotation_y(bend_rad);
        let mut leg = Leg::new(&pose, &skeleton, side);
        reach(&mut pose, &mut leg, &skeleton, side, target);
        (pose, leg)
    }

    proptest! {
        #[test]
        fn the_ankle_reaches_its_target_or_stretches_towards_it(
            x in -1.5f32..1.5, y in -1.5f32..1.5, z in -1.0f32..2.0, bend_rad in 0.0f32..1.5, side in 0usize..2,
        ) {
            let target = FootPose { ankle_m: Vec3::new(x, y, z), orientation: Quat::from_rotation_z(0.4) };
            let (pose, leg) = reached(side, bend_rad, &target);
            let (hip_m, ankle_m) = (leg.hip_m(), leg.foot().ankle_m);
            let nearest_m = hip_m
                + (target.ankle_m - hip_m).normalize() * reachable_m([0.42, 0.42], target.ankle_m.distance(hip_m));
            prop_assert!(ankle_m.distance(nearest_m) < 1e-4, "{ankle_m} {nearest_m}");
            prop_assert!(leg.foot().orientation.angle_between(target.orientation) < 1e-3);
            let again = Leg::new(&pose, &skeleton(), side);
            prop_assert!(again.positions_m.iter().zip(leg.positions_m).all(|(a, b)| a.distance(b) < 1e-4));
        }
    }

    #[test]
    fn a_foot_that_is_where_it_should_be_moves_nothing() {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        pose.rotations[Joint::THIGHS[0].index()] = Quat::from_rotation_y(-0.5) * Quat::from_rotation_z(0.2);
        pose.rotations[Joint::SHANKS[0].index()] = Quat::from_rotation_y(0.9);
        let before = pose;
        let mut leg = Leg::new(&pose, &skeleton, 0);
        let target = leg.foot();
        reach(&mut pose, &mut leg, &skeleton, 0, &target);
        for (before, after) in before.rotations.iter().zip(pose.rotations) {
            assert!(before.angle_between(after) < 2e-3);
        }
    }

    #[test]
    fn a_straight_leg_bends_its_knee_forward() {
        let target = FootPose { ankle_m: Vec3::new(0.0, 0.1, 0.3), orientation: Quat::IDENTITY };
        let (_, leg) = reached(0, 0.0, &target);
        assert!(leg.positions_m[1].x > 0.1);
    }

    #[test]
    fn a_target_in_the_hip_itself_is_no_catastrophe() {
        let hip_m = skeleton().offsets_m[0] + skeleton().offsets_m[Joint::LeftThigh.index()];
        let (pose, _) = reached(0, 0.0, &FootPose { ankle_m: hip_m, orientation: Quat::IDENTITY });
        assert!(pose.rotations.iter().all(|rotation| rotation.is_normalized()));
    }
}

//! Two-bone inverse kinematics of a leg: hip and knee bend so that the ankle meets a point; the foot keeps a given
//! orientation.
//!
//! Analytic, by the law of cosines. The leg stays in its plane, which turns with the line from hip to ankle, so the
//! knee remains the hinge that the pose had.
//!
//! Root frame (x forward, y left, z up), metres; orientations are relative to the rest pose.

use std::f32::consts::PI;

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};

use crate::synthesis::pose::leg::{FootPose, PosedLeg};

/// Greatest distance from hip to ankle, divided by thigh plus shank: the angle of a straight knee changes infinitely
/// fast.
const EXTENSION_MAX: f32 = 0.999;
/// Least distance from hip to ankle, divided by the difference of thigh and shank: the angle of a folded knee changes
/// infinitely fast, too.
const FLEXION_MARGIN: f32 = 1.001;
/// Distance of a straight leg's knee before the line from hip to ankle, m: it gives the leg a plane, bent forward. At 1
/// mm the knee swings out to the side where the pose difference after a switch straightens the leg.
const KNEE_AHEAD_M: f32 = 0.02;
/// 1 + cosine of the angle above which rounding leaves two directions no common axis: π − 1 mrad.
const OPPOSITE: f32 = 5e-7;

/// Moves one leg, and its joints in `pose`, to the target, or to the nearest point in reach.
///
/// Within its plane each bone turns to where the law of cosines requires it. Then the plane turns from the old line
/// between hip and ankle to the new one.
pub(crate) fn reach(pose: &mut Pose, leg: &mut PosedLeg, skeleton: &Skeleton, side: usize, target: &FootPose) {
    let [thigh, shank, foot, _] = PosedLeg::joints(side);
    let [hip_m, knee_m, ankle_m] = leg.positions_m;
    let [old_thigh, old_shank, ..] = leg.orientations;
    let (thigh_m, shank_m, line_m) = (knee_m - hip_m, ankle_m - knee_m, ankle_m - hip_m);
    let to_target_m = target.ankle_m - hip_m;

    let (line_length_m, target_length_m) = (line_m.length(), to_target_m.length());
    let line = if line_length_m > 0.0 { line_m / line_length_m } else { Vec3::NEG_Z };
    let distance_m = reachable_m(leg.bones_m, target_length_m);
    let (along_m, across_m) = knee_offset_m(leg.bones_m, distance_m);
    let bent_thigh_m = along_m * line + across_m * knee_direction(thigh_m, old_thigh * Vec3::X, line);
    let bent_shank_m = distance_m * line - bent_thigh_m;

    let swing = shortest_arc(line_m, to_target_m, line_length_m * target_length_m);
    let [thigh_length_m, shank_length_m] = leg.bones_m;
    let bend_thigh = shortest_arc(thigh_m, bent_thigh_m, thigh_length_m * thigh_length_m);
    let bend_shank = shortest_arc(shank_m, bent_shank_m, shank_length_m * shank_length_m);
    let new_thigh = (swing * bend_thigh * old_thigh).normalize();
    let new_shank = (swing * bend_shank * old_shank).normalize();

    pose.rotations[thigh] = pose.rotations[Joint::Pelvis.index()].conjugate() * new_thigh;
    pose.rotations[shank] = new_thigh.conjugate() * new_shank;
    pose.rotations[foot] = new_shank.conjugate() * target.orientation;
    let knee_m = hip_m + new_thigh * skeleton.offsets_m[shank];
    let ankle_m = knee_m + new_shank * skeleton.offsets_m[foot];
    leg.positions_m = [hip_m, knee_m, ankle_m];
    leg.orientations = [new_thigh, new_shank, target.orientation];
}

/// The distance from hip to ankle nearest to `distance_m` that a leg can have, m.
fn reachable_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> f32 {
    let least_m = FLEXION_MARGIN * (thigh_m - shank_m).abs();
    distance_m.clamp(least_m, (EXTENSION_MAX * (thigh_m + shank_m)).max(least_m))
}

/// Position of the knee relative to the hip, along the line from hip to ankle and across it, m (law of cosines).
fn knee_offset_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> (f32, f32) {
    let distance_m = distance_m.max(f32::EPSILON);
    let along_m = 0.5 * (distance_m + (thigh_m * thigh_m - shank_m * shank_m) / distance_m);
    (along_m, libm::sqrtf((thigh_m * thigh_m - along_m * along_m).max(0.0)))
}

/// Unit vector across the line from hip to ankle to which the knee bends: that of the pose, turned forward. The
/// difference of poses after a switch may hyperextend a knee; it then bends forward on the same hinge.
fn knee_direction(knee_m: Vec3, forward: Vec3, line: Vec3) -> Vec3 {
    let across = |vector: Vec3| vector - line * vector.dot(line);
    let forward = across(forward).try_normalize().unwrap_or_else(|| line.any_orthonormal_vector());
    let knee_m = across(knee_m);
    let ahead_m = knee_m.dot(forward);
    (knee_m + (libm::sqrtf(ahead_m * ahead_m + KNEE_AHEAD_M * KNEE_AHEAD_M) - ahead_m) * forward).normalize()
}

/// The shortest rotation from the direction of one vector to that of another, not normalised, given the product of
/// their lengths. Exact for small angles. Opposite vectors give a half turn about any axis across; a zero vector gives
/// none.
fn shortest_arc(from: Vec3, to: Vec3, lengths: f32) -> Quat {
    let (cross, one_plus_cosine) = (from.cross(to), lengths + from.dot(to));
    if one_plus_cosine > OPPOSITE * lengths {
        Quat::from_xyzw(cross.x, cross.y, cross.z, one_plus_cosine)
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

    /// A standing body with one knee bent by `bend_rad` whose leg reaches for a target.
    fn reached(side: usize, bend_rad: f32, target: &FootPose) -> (Pose, PosedLeg) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        pose.rotations[Joint::SHANKS[side].index()] = Quat::from_rotation_y(bend_rad);
        let mut leg = PosedLeg::new(&pose, &skeleton, side);
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
            let again = PosedLeg::new(&pose, &skeleton(), side);
            prop_assert!(again.positions_m.iter().zip(leg.positions_m).all(|(a, b)| a.distance(b) < 1e-4));
        }
    }

    #[test]
    fn a_foot_at_its_target_moves_no_joint() {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        pose.rotations[Joint::THIGHS[0].index()] = Quat::from_rotation_y(-0.5) * Quat::from_rotation_z(0.2);
        pose.rotations[Joint::SHANKS[0].index()] = Quat::from_rotation_y(0.9);
        let before = pose;
        let mut leg = PosedLeg::new(&pose, &skeleton, 0);
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
    fn a_target_in_the_hip_gives_a_valid_pose() {
        let hip_m = skeleton().offsets_m[0] + skeleton().offsets_m[Joint::LeftThigh.index()];
        let (pose, _) = reached(0, 0.0, &FootPose { ankle_m: hip_m, orientation: Quat::IDENTITY });
        assert!(pose.rotations.iter().all(|rotation| rotation.is_normalized()));
    }
}

//! Inverse kinematics of a leg: hip and knee bend so that the ankle meets a point ([`two_bone_reach`]); the foot keeps a
//! given orientation.
//!
//! Root frame (x forward, y left, z up), metres; orientations are relative to the rest pose.

use motiondb::body::two_bone_reach::{self, TwoBones};
use motiondb::body::{Joint, Pose, Skeleton};

use crate::synthesis::pose::leg::{FootPose, PosedLeg};

/// Moves one leg, and its joints in `pose`, to the target, or to the nearest point in reach.
pub(crate) fn reach(pose: &mut Pose, leg: &mut PosedLeg, skeleton: &Skeleton, side: usize, target: &FootPose) {
    let [thigh, shank, foot, _] = PosedLeg::joints(side);
    let [old_thigh, old_shank, ..] = leg.orientations;
    let bones = TwoBones { positions_m: leg.positions_m, orientations: [old_thigh, old_shank], lengths_m: leg.bones_m };
    let [new_thigh, new_shank] = two_bone_reach::reach(&bones, target.ankle_m);

    pose.rotations[thigh] = pose.rotations[Joint::Pelvis.index()].conjugate() * new_thigh;
    pose.rotations[shank] = new_thigh.conjugate() * new_shank;
    pose.rotations[foot] = new_shank.conjugate() * target.orientation;
    let hip_m = leg.positions_m[0];
    let knee_m = hip_m + new_thigh * skeleton.offsets_m[shank];
    let ankle_m = knee_m + new_shank * skeleton.offsets_m[foot];
    leg.positions_m = [hip_m, knee_m, ankle_m];
    leg.orientations = [new_thigh, new_shank, target.orientation];
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use motiondb::body::JOINT_COUNT;
    use motiondb::body::two_bone_reach::reachable_m;
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

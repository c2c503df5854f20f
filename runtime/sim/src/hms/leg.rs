//! The legs of a posed body: all of its forward kinematics that foot holding, pelvis and IK ask for.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres; orientations are against the rest pose.

use glam::{Quat, Vec3};
use motiondb::pose::Pose;
use motiondb::skeleton::{Joint, Skeleton};

/// One leg, from the hip down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Hip, knee, ankle and the ball's joint.
    pub positions_m: [Vec3; 4],
    /// Of thigh, shank, foot and toes.
    pub orientations: [Quat; 4],
    /// Lengths of thigh and shank.
    pub bones_m: [f32; 2],
}

impl Leg {
    /// Indices of its joints in a pose, from the hip down.
    pub const fn joints(side: usize) -> [usize; 4] {
        let thigh = Joint::THIGHS[side].index();
        [thigh, thigh + 1, thigh + 2, thigh + 3]
    }

    /// As posed.
    pub fn new(pose: &Pose, skeleton: &Skeleton, side: usize) -> Self {
        let (mut position_m, mut orientation) = (pose.pelvis_m, pose.rotations[Joint::Pelvis.index()]);
        let joints = Self::joints(side);
        let bones_m = [joints[1], joints[2]].map(|below| skeleton.offsets_m[below].length());
        let mut leg = Self { positions_m: [position_m; 4], orientations: [orientation; 4], bones_m };
        for (below, joint) in joints.into_iter().enumerate() {
            position_m += orientation * skeleton.offsets_m[joint];
            orientation *= pose.rotations[joint];
            (leg.positions_m[below], leg.orientations[below]) = (position_m, orientation);
        }
        leg
    }

    /// The hip.
    pub fn hip_m(&self) -> Vec3 {
        self.positions_m[0]
    }

    /// The ankle.
    pub fn ankle_m(&self) -> Vec3 {
        self.positions_m[2]
    }

    /// Of the foot.
    pub fn foot(&self) -> Quat {
        self.orientations[2]
    }

    /// Heel, ball and toe tip on the sole.
    pub fn sole_points_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        let sole = &skeleton.feet[side];
        let [_, _, ankle_m, toe_m] = self.positions_m;
        let [_, _, foot, toe] = self.orientations;
        [ankle_m + foot * sole.heel_m, ankle_m + foot * sole.ball_m, toe_m + toe * sole.toe_tip_m]
    }

    /// Height of the lowest of them, m.
    pub fn sole_height_m(&self, skeleton: &Skeleton, side: usize) -> f32 {
        self.sole_points_m(skeleton, side).into_iter().fold(f32::INFINITY, |lowest_m, point_m| lowest_m.min(point_m.z))
    }
}

/// Both legs, `[left, right]`.
pub fn legs(pose: &Pose, skeleton: &Skeleton) -> [Leg; 2] {
    [0, 1].map(|side| Leg::new(pose, skeleton, side))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn legs_are_where_forward_kinematics_has_them() {
        let db = test_db();
        for row in 0..motiondb::motion_db::PHASE_COUNT {
            let pose = db.rows.pose(1, row);
            let joints = pose.forward_kinematics(&db.skeleton);
            for (side, leg) in legs(&pose, &db.skeleton).iter().enumerate() {
                for (below, joint) in Leg::joints(side).into_iter().enumerate() {
                    assert!(leg.positions_m[below].distance(joints.positions_m[joint]) < 1e-6);
                    assert!(leg.orientations[below].abs_diff_eq(joints.orientations[joint], 1e-6));
                }
                let soles_m =
                    leg.sole_points_m(&db.skeleton, side).into_iter().zip(joints.sole_points_m(&db.skeleton, side));
                assert!(soles_m.into_iter().all(|(leg_m, joints_m)| leg_m.distance(joints_m) < 1e-6));
            }
        }
    }
}

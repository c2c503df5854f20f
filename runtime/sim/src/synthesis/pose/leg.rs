//! The legs of a pose: the part of forward kinematics that foot locks, pelvis and inverse kinematics need.
//!
//! Root frame (x forward, y left, z up), metres; orientations are relative to the rest pose. Pairs are `[left, right]`.

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};

/// One posed leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PosedLeg {
    /// Positions of hip, knee and ankle, m.
    pub positions_m: [Vec3; 3],
    /// Orientations of thigh, shank and foot.
    pub orientations: [Quat; 3],
    /// Lengths of thigh and shank, m.
    pub bones_m: [f32; 2],
}

/// Position and orientation of a foot. The pose determines the bend of its toes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootPose {
    /// Position of the ankle, m.
    pub ankle_m: Vec3,
    /// Orientation of the foot joint.
    pub orientation: Quat,
}

impl PosedLeg {
    /// Indices of the joints of a leg in a pose: thigh, shank, foot, toe.
    pub(crate) const fn joints(side: usize) -> [usize; 4] {
        let thigh = Joint::THIGHS[side].index();
        [thigh, thigh + 1, thigh + 2, thigh + 3]
    }

    /// The leg of a pose on one side.
    pub(crate) fn new(pose: &Pose, skeleton: &Skeleton, side: usize) -> Self {
        let [thigh, shank, foot, _] = Self::joints(side);
        let chain = pose.chain(skeleton, [thigh, shank, foot]);
        Self {
            positions_m: chain.map(|(position_m, _)| position_m),
            orientations: chain.map(|(_, orientation)| orientation),
            bones_m: [skeleton.offsets_m[shank].length(), skeleton.offsets_m[foot].length()],
        }
    }

    /// Position of the hip, m.
    pub(crate) fn hip_m(&self) -> Vec3 {
        self.positions_m[0]
    }

    /// Position and orientation of the foot.
    pub(crate) fn foot(&self) -> FootPose {
        FootPose { ankle_m: self.positions_m[2], orientation: self.orientations[2] }
    }
}

impl FootPose {
    /// Heel, ball and toe tip on the sole, m; `pose` bends the toes.
    pub fn sole_points_m(&self, pose: &Pose, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        let (sole, [_, _, _, toe]) = (&skeleton.feet[side], PosedLeg::joints(side));
        let toe_tip_m = skeleton.offsets_m[toe] + pose.rotations[toe] * sole.toe_tip_m;
        [sole.heel_m, sole.ball_m, toe_tip_m].map(|point_m| self.ankle_m + self.orientation * point_m)
    }
}

/// Both legs of a pose.
pub(crate) fn legs(pose: &Pose, skeleton: &Skeleton) -> [PosedLeg; 2] {
    [0, 1].map(|side| PosedLeg::new(pose, skeleton, side))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn legs_match_forward_kinematics() {
        let db = test_db();
        for row in 0..motiondb::motion::PHASE_COUNT {
            let pose = db.rows.pose(1, row);
            let joints = pose.forward_kinematics(&db.skeleton);
            for (side, leg) in legs(&pose, &db.skeleton).iter().enumerate() {
                for (index, joint) in PosedLeg::joints(side).into_iter().take(3).enumerate() {
                    assert_eq!(leg.positions_m[index], joints.positions_m[joint]);
                    assert_eq!(leg.orientations[index], joints.orientations[joint]);
                }
                let soles_m = leg.foot().sole_points_m(&pose, &db.skeleton, side).into_iter();
                let mut both_m = soles_m.zip(joints.sole_points_m(&db.skeleton, side));
                assert!(both_m.all(|(leg_m, joints_m)| leg_m.distance(joints_m) < 1e-6));
            }
        }
    }
}

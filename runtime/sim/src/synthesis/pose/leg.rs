//! The legs of a posed body: all of its forward kinematics that foot holding, pelvis and IK ask for.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres; orientations are against the rest pose.

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};

/// One leg, from the hip down to the ankle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Hip, knee and ankle.
    pub positions_m: [Vec3; 3],
    /// Of thigh, shank and foot.
    pub orientations: [Quat; 3],
    /// Lengths of thigh and shank.
    pub bones_m: [f32; 2],
}

/// Where a foot is, or shall be; the toes keep the bend that the pose has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootPose {
    /// The ankle.
    pub ankle_m: Vec3,
    /// Of the foot joint.
    pub orientation: Quat,
}

impl Leg {
    /// Indices of its joints in a pose, from the hip down.
    pub const fn joints(side: usize) -> [usize; 4] {
        let thigh = Joint::THIGHS[side].index();
        [thigh, thigh + 1, thigh + 2, thigh + 3]
    }

    /// As posed.
    pub fn new(pose: &Pose, skeleton: &Skeleton, side: usize) -> Self {
        let [thigh, shank, foot, _] = Self::joints(side);
        let (rotations, offsets_m) = (&pose.rotations, &skeleton.offsets_m);
        let pelvis = rotations[Joint::Pelvis.index()];
        let hip_m = pose.pelvis_m + pelvis * offsets_m[thigh];
        let thigh_turned = pelvis * rotations[thigh];
        let knee_m = hip_m + thigh_turned * offsets_m[shank];
        let shank_turned = thigh_turned * rotations[shank];
        let ankle_m = knee_m + shank_turned * offsets_m[foot];
        Self {
            positions_m: [hip_m, knee_m, ankle_m],
            orientations: [thigh_turned, shank_turned, shank_turned * rotations[foot]],
            bones_m: [offsets_m[shank].length(), offsets_m[foot].length()],
        }
    }

    /// The hip.
    pub fn hip_m(&self) -> Vec3 {
        self.positions_m[0]
    }

    /// Its foot.
    pub fn foot(&self) -> FootPose {
        FootPose { ankle_m: self.positions_m[2], orientation: self.orientations[2] }
    }
}

impl FootPose {
    /// Heel, ball and toe tip on the sole, where a pose bends the toes.
    pub fn sole_points_m(&self, pose: &Pose, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        let (sole, [_, _, _, toe]) = (&skeleton.feet[side], Leg::joints(side));
        let toe_tip_m = skeleton.offsets_m[toe] + pose.rotations[toe] * sole.toe_tip_m;
        [sole.heel_m, sole.ball_m, toe_tip_m].map(|point_m| self.ankle_m + self.orientation * point_m)
    }
}

/// Both legs, `[left, right]`.
pub(crate) fn legs(pose: &Pose, skeleton: &Skeleton) -> [Leg; 2] {
    [0, 1].map(|side| Leg::new(pose, skeleton, side))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn legs_are_where_forward_kinematics_has_them() {
        let db = test_db();
        for row in 0..motiondb::motion::PHASE_COUNT {
            let pose = db.rows.pose(1, row);
            let joints = pose.forward_kinematics(&db.skeleton);
            for (side, leg) in legs(&pose, &db.skeleton).iter().enumerate() {
                for (below, joint) in Leg::joints(side).into_iter().take(3).enumerate() {
                    assert!(leg.positions_m[below].distance(joints.positions_m[joint]) < 1e-6);
                    assert!(leg.orientations[below].abs_diff_eq(joints.orientations[joint], 1e-6));
                }
                let soles_m = leg.foot().sole_points_m(&pose, &db.skeleton, side).into_iter();
                let mut both_m = soles_m.zip(joints.sole_points_m(&db.skeleton, side));
                assert!(both_m.all(|(leg_m, joints_m)| leg_m.distance(joints_m) < 1e-6));
            }
        }
    }
}

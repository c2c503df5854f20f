//! One frame of a clip, and its forward kinematics.

use glam::{DQuat, DVec3};

use crate::body::skeleton::{ANKLE_HEIGHT_M, JOINT_COUNT, SHANK_M, THIGH_M, joints_at_rest};

/// One frame: the root in the world, and the rotation of every joint against its parent.
#[derive(Clone, Debug)]
pub(crate) struct ClipPose {
    /// Midpoint of the hips, world, m.
    pub(crate) hips_m: DVec3,
    /// Local rotations; the root's against the world.
    pub(crate) rotations: [DQuat; JOINT_COUNT],
}

impl ClipPose {
    /// The rest pose, a T-pose with its soles on the ground.
    pub(crate) fn rest() -> Self {
        let hips_m = DVec3::new(0.0, 0.0, THIGH_M + SHANK_M + ANKLE_HEIGHT_M);
        Self { hips_m, rotations: [DQuat::IDENTITY; JOINT_COUNT] }
    }

    /// Position of every joint in the world, m.
    pub(crate) fn positions_m(&self) -> [DVec3; JOINT_COUNT] {
        let mut positions_m = [self.hips_m; JOINT_COUNT];
        let mut orientations = self.rotations;
        for (index, joint) in joints_at_rest().iter().enumerate().skip(1) {
            positions_m[index] = positions_m[joint.parent] + orientations[joint.parent] * joint.offset_m;
            orientations[index] = orientations[joint.parent] * self.rotations[index];
        }
        positions_m
    }
}

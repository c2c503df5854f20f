//! The three rounds of a loop, computed from the one that is stored. World frame: metres, radians, Z up.

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use serde::{Deserialize, Serialize};

use crate::ground::grounded_poses::GroundedPoses;
use crate::ground::rotations::{align_hemispheres, flip, ground_rotation, rotation_vector};
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Copies of a loop: one before and one after the copy that is analysed.
const ROUNDS: usize = 3;

/// How the poses of three rounds follow from those of one.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct LoopRounds {
    /// Frames of one round.
    pub(crate) round: usize,
    pub(crate) seam: LoopSeam,
    /// The joints, one bit each, whose quaternion is negated in each frame, so that successive poses lie in one
    /// hemisphere; empty where the poses are not the clip's own.
    pub(crate) flipped: Vec<u32>,
}

impl LoopRounds {
    /// Number of frames: three rounds and the frame after them.
    pub(crate) fn frame_count(&self) -> usize {
        ROUNDS * self.round + 1
    }

    /// The pose of a frame. `poses` are those of one round, closed where they are its own.
    pub(crate) fn pose(&self, poses: &GroundedPoses, frame: usize) -> HumanPose {
        let mut pose = self.carried(poses, frame);
        self.flipped.get(frame).into_iter().for_each(|&joints| flip(&mut pose.rotations, joints));
        pose
    }

    /// The pose of a frame, in any hemisphere.
    fn carried(&self, poses: &GroundedPoses, frame: usize) -> HumanPose {
        let mut pose = poses.pose(frame % self.round);
        if matches!(poses, GroundedPoses::Moved { .. }) {
            self.close(&mut pose, frame % self.round);
        }
        self.seam.carry(&mut pose, frame / self.round);
        pose
    }

    /// Closes a pose of the round.
    pub(crate) fn close(&self, pose: &mut HumanPose, frame: usize) {
        self.seam.close(pose, frame as f64 / self.round as f64);
    }

    /// Finds the quaternions to negate.
    pub(crate) fn align_successive(&mut self, poses: &GroundedPoses) {
        let mut before: Option<[DQuat; JOINT_COUNT]> = None;
        for frame in 0..self.frame_count() {
            let mut rotations = self.carried(poses, frame).rotations;
            self.flipped.push(before.map_or(0, |before| align_hemispheres(&mut rotations, &before)));
            before = Some(rotations);
        }
    }
}

/// Displacement of the body by one round of a loop, and the gap that the round leaves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct LoopSeam {
    /// Pelvis of the first pose on the ground, m.
    start_m: DVec3,
    /// Displacement of the pelvis on the ground by one round, m.
    travelled_m: DVec3,
    /// Change of the facing by one round, rad.
    turned_rad: f64,
    /// Height of the first pelvis above the last, m.
    height_gap_m: f64,
    /// Rotations from the last pose's joints back to the first's, as rotation vectors, rad.
    rotation_gaps: [DVec3; JOINT_COUNT],
    /// The same of the extra joints.
    extra_gaps: Box<[DVec3]>,
}

impl LoopSeam {
    pub(crate) fn between(first: &HumanPose, last: &HumanPose, body: &HumanBody) -> Self {
        let (from, to) = (first.forward_kinematics(body), last.forward_kinematics(body));
        let turned_rad = to.facing_rad() - from.facing_rad();
        let turn = DQuat::from_rotation_z(turned_rad);
        let rotation_gaps = std::array::from_fn(|joint| {
            let closing = if joint == 0 { turn * first.rotations[0] } else { first.rotations[joint] };
            rotation_vector(closing * last.rotations[joint].inverse())
        });
        let extra = first.extra.iter().zip(&last.extra);
        let extra_gaps = extra.map(|(first, last)| rotation_vector(*first * last.inverse())).collect();
        let travelled_m = (last.pelvis_m - first.pelvis_m).with_z(0.0);
        let height_gap_m = first.pelvis_m.z - last.pelvis_m.z;
        Self { start_m: first.pelvis_m.with_z(0.0), travelled_m, turned_rad, height_gap_m, rotation_gaps, extra_gaps }
    }

    /// Adds its part of the gap to a pose of the round: none at the first pose, all at the last.
    fn close(&self, pose: &mut HumanPose, share: f64) {
        pose.pelvis_m.z += self.height_gap_m * share;
        let roles = pose.rotations.iter_mut().zip(&self.rotation_gaps);
        for (rotation, gap) in roles.chain(pose.extra.iter_mut().zip(&self.extra_gaps)) {
            *rotation = DQuat::from_scaled_axis(*gap * share) * *rotation;
        }
    }

    /// Moves a pose some rounds on.
    fn carry(&self, pose: &mut HumanPose, rounds: usize) {
        for _ in 0..rounds {
            let from_start_m = ground_rotation(self.turned_rad) * (pose.pelvis_m - self.start_m).truncate();
            pose.pelvis_m = self.start_m + self.travelled_m + from_start_m.extend(pose.pelvis_m.z);
            pose.rotations[0] = DQuat::from_rotation_z(self.turned_rad) * pose.rotations[0];
        }
    }
}

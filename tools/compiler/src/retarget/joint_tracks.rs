//! Tracks of the canonical joints on the source, before calibration: positions, and directions between joints.
//!
//! World frame of the clip: metres, z up.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};

use crate::read::source_clip::SourceClip;
use crate::retarget::anchors::JointAnchor;
use crate::rig::roles::Roles;

/// Length below which a bone has no direction, m.
const SHORTEST_BONE_M: f64 = 0.01;
/// Share of the frames, flattest first, in which a foot counts as flat on the ground.
const FLAT_SHARE: f64 = 0.15;

/// Positions of all canonical joints in all frames, and the source that they come from.
pub(crate) struct JointTracks<'a> {
    pub clip: &'a SourceClip,
    pub roles: &'a Roles,
    pub anchors: &'a [JointAnchor; JOINT_COUNT],
    /// Positions of all canonical joints, one array for each frame, m.
    pub positions_m: &'a [[DVec3; JOINT_COUNT]],
    /// Unit vector of the body's facing on the ground, for each frame.
    pub forward: &'a [DVec3],
}

impl JointTracks<'_> {
    /// Global orientation of the source joint that carries a canonical joint.
    pub(crate) fn source_orientation(&self, joint: Joint, frame: usize) -> DQuat {
        self.clip.orientation(frame, self.anchors[joint.index()].joint)
    }

    /// The body's left on the ground, unit vector.
    pub(crate) fn left(&self, frame: usize) -> DVec3 {
        DVec3::Z.cross(self.forward[frame])
    }

    /// Axis about which a knee bends, as long as the sine of the bend.
    pub(crate) fn knee_hinge(&self, side: usize, frame: usize) -> Option<DVec3> {
        let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]];
        Some(self.direction(thigh, shank, frame)?.cross(self.direction(shank, foot, frame)?))
    }

    /// Midpoint of a pair of joints, m.
    pub(crate) fn middle(&self, pair: [Joint; 2], frame: usize) -> DVec3 {
        0.5 * (self.positions_m[frame][pair[0].index()] + self.positions_m[frame][pair[1].index()])
    }

    /// Unit vector between two joints; none where they are at one position.
    pub(crate) fn direction(&self, from: Joint, to: Joint, frame: usize) -> Option<DVec3> {
        let bone = self.positions_m[frame][to.index()] - self.positions_m[frame][from.index()];
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }

    /// Unit vector to the far end of a leaf's segment; none where the source has no such end.
    pub(crate) fn direction_to_end(&self, joint: Joint, frame: usize) -> Option<DVec3> {
        let end = self.clip.position(frame, self.roles.ends[joint.index()]?);
        let bone = end - self.positions_m[frame][joint.index()];
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }

    /// The frames in which some joints are flat on the ground: the higher one, each over its own lowest, is lowest.
    pub(crate) fn flat_frames(&self, joints: &[Joint]) -> Vec<usize> {
        let height = |frame: usize, joint: &Joint| self.positions_m[frame][joint.index()].z;
        let frames = 0..self.positions_m.len();
        let lowest: Vec<f64> = joints
            .iter()
            .map(|joint| frames.clone().map(|frame| height(frame, joint)).fold(f64::INFINITY, f64::min))
            .collect();
        let lift = |frame: usize| {
            joints.iter().zip(&lowest).map(|(joint, lowest)| height(frame, joint) - lowest).fold(0.0, f64::max)
        };
        let mut sorted: Vec<(f64, usize)> = frames.map(|frame| (lift(frame), frame)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let count = ((sorted.len() as f64 * FLAT_SHARE) as usize).max(1);
        sorted[..count].iter().map(|&(_, frame)| frame).collect()
    }

    /// Mean of a world point in the frame of a canonical joint, m. `orientations` are those after calibration.
    pub(crate) fn mean_in_frame_of(
        &self,
        joint: Joint,
        orientations: &[[DQuat; JOINT_COUNT]],
        point_m: impl Fn(usize) -> DVec3,
    ) -> DVec3 {
        let index = joint.index();
        let local =
            |frame: usize| orientations[frame][index].inverse() * (point_m(frame) - self.positions_m[frame][index]);
        (0..orientations.len()).map(local).sum::<DVec3>() / orientations.len() as f64
    }

    /// Mean far end of a leaf's segment in its own frame, m; none where the source has no such end.
    pub(crate) fn mean_end(&self, joint: Joint, orientations: &[[DQuat; JOINT_COUNT]]) -> Option<DVec3> {
        let end = self.roles.ends[joint.index()]?;
        Some(self.mean_in_frame_of(joint, orientations, |frame| self.clip.position(frame, end)))
    }
}

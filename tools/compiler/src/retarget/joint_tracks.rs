//! Tracks of the canonical joints on the source: positions, directions between joints, and orientations.
//!
//! All are computed from the source where they are needed, so that the poses of a long clip are held once. World frame
//! of the clip: metres, z up.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};

use crate::read::source_clip::SourceClip;
use crate::retarget::anchors::JointAnchor;
use crate::retarget::units;
use crate::rig::roles::Roles;

/// Length below which a bone has no direction, m.
const SHORTEST_BONE_M: f64 = 0.01;
/// Share of the frames, flattest first, in which a foot counts as flat on the ground.
const FLAT_SHARE: f64 = 0.15;

/// The canonical joints of a source in all frames, before calibration.
#[derive(Clone, Copy)]
pub(crate) struct JointTracks<'a> {
    pub clip: &'a SourceClip,
    pub roles: &'a Roles,
    pub anchors: &'a [JointAnchor; JOINT_COUNT],
    /// Unit vector of the body's facing on the ground, for each frame.
    pub forward: &'a [DVec3],
    /// The frames in which the body is upright; all frames where it never is. Feet of a kneeling body lie on their
    /// insteps.
    pub upright: &'a [usize],
}

/// The canonical joints of a source in all frames, after calibration.
pub(crate) struct CalibratedTracks<'a> {
    pub tracks: JointTracks<'a>,
    /// Rotation K_j of each canonical joint in its source joint's frame.
    pub constants: &'a [DQuat; JOINT_COUNT],
}

impl JointTracks<'_> {
    /// Number of frames.
    pub(crate) fn frame_count(&self) -> usize {
        self.clip.frame_count()
    }

    /// Position of a canonical joint, m. The pelvis is the hips' midpoint even where the hips are not rigid.
    pub(crate) fn position_m(&self, joint: Joint, frame: usize) -> DVec3 {
        match joint {
            Joint::Pelvis => units::middle(self.clip, self.roles, Joint::THIGHS, frame),
            _ => self.anchors[joint.index()].position_m(self.clip, frame),
        }
    }

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
        0.5 * (self.position_m(pair[0], frame) + self.position_m(pair[1], frame))
    }

    /// Unit vector between two joints; none where they are at one position.
    pub(crate) fn direction(&self, from: Joint, to: Joint, frame: usize) -> Option<DVec3> {
        let bone = self.position_m(to, frame) - self.position_m(from, frame);
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }

    /// Unit vector to the far end of a leaf's segment; none where the source has no such end.
    pub(crate) fn direction_to_end(&self, joint: Joint, frame: usize) -> Option<DVec3> {
        let end = self.clip.position(frame, self.roles.ends[joint.index()]?);
        let bone = end - self.position_m(joint, frame);
        (bone.length() > SHORTEST_BONE_M).then(|| bone.normalize())
    }

    /// The upright frames in which some joints are flat on the ground: the higher one, each over its own lowest, is
    /// lowest.
    pub(crate) fn flat_frames(&self, joints: &[Joint]) -> Vec<usize> {
        let height = |frame: usize, joint: &Joint| self.position_m(*joint, frame).z;
        let frames = self.upright.iter().copied();
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

    /// Orientation of a canonical joint, R_j(t) = G_j(t)·K_j.
    pub(crate) fn orientation(&self, joint: Joint, frame: usize, constants: &[DQuat; JOINT_COUNT]) -> DQuat {
        (self.source_orientation(joint, frame) * constants[joint.index()]).normalize()
    }
}

impl CalibratedTracks<'_> {
    /// Orientation of a canonical joint. The pelvis is turned until its y axis is the hip line: hips may move in the
    /// pelvis. CMU's hip helpers turn, drawn characters stretch.
    pub(crate) fn orientation(&self, joint: Joint, frame: usize) -> DQuat {
        let turn = self.tracks.orientation(joint, frame, self.constants);
        if joint != Joint::Pelvis {
            return turn;
        }
        let [left, right] = Joint::THIGHS.map(|hip| self.tracks.position_m(hip, frame));
        let aimed = |line: DVec3| (DQuat::from_rotation_arc(turn * DVec3::Y, line) * turn).normalize();
        (left - right).try_normalize().map_or(turn, aimed)
    }

    /// Mean of a world point in the frame of a canonical joint, m.
    pub(crate) fn mean_in_frame_of(&self, joint: Joint, point_m: impl Fn(usize) -> DVec3) -> DVec3 {
        let local = |frame: usize| {
            self.orientation(joint, frame).inverse() * (point_m(frame) - self.tracks.position_m(joint, frame))
        };
        let frames = self.tracks.frame_count();
        (0..frames).map(local).sum::<DVec3>() / frames as f64
    }

    /// Mean far end of a leaf's segment in its own frame, m; none where the source has no such end.
    pub(crate) fn mean_end(&self, joint: Joint) -> Option<DVec3> {
        let end = self.tracks.roles.ends[joint.index()]?;
        Some(self.mean_in_frame_of(joint, |frame| self.tracks.clip.position(frame, end)))
    }
}

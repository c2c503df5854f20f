//! An extra joint as a clip shows it. Metres; the frames of [`motiondb::body::extra_joint`].

use glam::{DQuat, DVec3};
use motiondb::body::ExtraJoint;
use serde::{Deserialize, Serialize};

/// An extra joint of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClipExtra {
    /// What the joint is.
    pub joint: ExtraJoint,
    /// Position relative to its parent in the parent's frame, mean over the clip, m.
    pub offset_m: DVec3,
    /// Rotation in its parent's frame, mean over the clip.
    pub mean: DQuat,
}

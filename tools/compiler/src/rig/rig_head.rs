//! The head's offset in a rig: the constant rotation between the source's head joint and an upright head, as one clip
//! shows it. World frame: z up.

use glam::DQuat;
use motiondb::body::Joint;
use serde::{Deserialize, Serialize};

use crate::read::source_clip::SourceClip;
use crate::rig::roles::Roles;

/// Step of the lengths of bones that tell rigs apart, leg lengths.
const BONE_STEP_LEGS: f64 = 0.002;

/// What tells rigs apart: names of the joints and lengths of the bones.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Rig {
    /// Name of the joint of each role.
    pub(crate) names: Vec<String>,
    /// Length of the bone to each role from its parent, in steps.
    pub(crate) lengths: Vec<i64>,
}

/// The rig of a clip, and the offset of its head as the clip alone shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigHead {
    pub(crate) rig: Rig,
    /// Rotation of an upright head in the frame of the source's head joint.
    pub(crate) offset: DQuat,
    /// The same by the rest pose, where that is a body that stands.
    pub(crate) rest_offset: Option<DQuat>,
    /// Axis of the source along which its rest pose stands, `+X` … `-Z`.
    pub(crate) rest_up: String,
}

impl RigHead {
    /// The rig of a clip in which the canonical head is turned by `offset` in its source joint's frame.
    pub(crate) fn of(clip: &SourceClip, roles: &Roles, leg_m: f64, offset: DQuat) -> Self {
        let name = |joint: &Option<usize>| joint.map_or_else(String::new, |joint| clip.joints[joint].name.clone());
        let position = |joint: Joint| roles.joints[joint.index()].map(|joint| clip.position(0, joint));
        let length = |joint: &Joint| {
            let (from, to) = (position(joint.parent()?)?, position(*joint)?);
            Some(libm::round(from.distance(to) / (BONE_STEP_LEGS * leg_m)) as i64)
        };
        let lengths = Joint::ALL.iter().map(|joint| length(joint).unwrap_or_default()).collect();
        let rig = Rig { names: roles.joints.iter().map(name).collect(), lengths };
        Self { rig, offset, rest_offset: None, rest_up: String::new() }
    }
}

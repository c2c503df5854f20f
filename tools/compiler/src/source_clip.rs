//! A clip as its file tells it: every joint's global position and orientation in every frame, in the source's units and
//! axes.
//!
//! Local rotations, rest poses and scales are gone at this point: what two formats disagree about ends here.

use glam::{DQuat, DVec3};

/// One joint of a source skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceJoint {
    /// As the file spells it; an end site takes its parent's name with `_end` appended.
    pub name: String,
    /// Index of its parent, always smaller than its own.
    pub parent: Option<usize>,
    /// An end site: a point that does not turn by itself.
    pub is_end: bool,
}

/// One clip, before anything is known about the body.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceClip {
    /// File name without folders.
    pub file: String,
    /// Clip within the file; empty where a file holds one unnamed clip.
    pub clip: String,
    /// A parent stands before its children.
    pub joints: Vec<SourceJoint>,
    /// Frames a second.
    pub frame_rate_hz: f64,
    /// Global positions in source units, frame-major: frame · joint count + joint.
    pub positions: Vec<DVec3>,
    /// Global orientations, in the same order.
    pub orientations: Vec<DQuat>,
    /// Metres per unit where the format defines it (glTF: 1).
    pub metres_per_unit: Option<f64>,
    /// What was odd in the file.
    pub warnings: Vec<String>,
}

impl SourceClip {
    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.positions.len().checked_div(self.joints.len()).unwrap_or(0)
    }

    /// Global position of a joint, source units.
    pub fn position(&self, frame: usize, joint: usize) -> DVec3 {
        self.positions[frame * self.joints.len() + joint]
    }

    /// Global orientation of a joint.
    pub fn orientation(&self, frame: usize, joint: usize) -> DQuat {
        self.orientations[frame * self.joints.len() + joint]
    }

    /// Drops the first frames.
    pub fn drop_first_frames(&mut self, count: usize) {
        let values = count * self.joints.len();
        self.positions.drain(..values);
        self.orientations.drain(..values);
    }
}

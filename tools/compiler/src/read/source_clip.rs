//! A clip as its file tells it: every joint's global position and orientation in every frame, in the source's units and
//! axes.
//!
//! Local rotations, rest poses and scales are gone at this point: what two formats disagree about ends here.

use std::ops::Range;

use glam::{DQuat, DVec3};
use motiondb::diagnostic::Diagnostic;

use crate::retarget::axis::Axis;

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
    /// Frames of the file before the first that is kept.
    pub first_frame: usize,
    /// Frames a second.
    pub frame_rate_hz: f64,
    /// Global positions in source units, frame-major: frame · joint count + joint.
    pub positions: Vec<DVec3>,
    /// Global orientations, in the same order.
    pub orientations: Vec<DQuat>,
    /// Metres per unit where the format (glTF: 1) or the manifest says it.
    pub metres_per_unit: Option<f64>,
    /// The axis that points up where the manifest says it; else it is found.
    pub up_axis: Option<Axis>,
    /// What was found in the file.
    pub diagnostics: Vec<Diagnostic>,
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

    /// Drops all frames but these.
    pub fn keep_frames(&mut self, frames: Range<usize>) {
        self.first_frame += frames.start;
        let (first, last) = (frames.start * self.joints.len(), frames.end * self.joints.len());
        self.positions.truncate(last);
        self.orientations.truncate(last);
        self.positions.drain(..first);
        self.orientations.drain(..first);
    }
}

//! A clip as its file holds it: global position and orientation of every joint in every frame, in the source's unit and
//! axes.
//!
//! Formats differ in local rotations, rest poses and scales; readers resolve these, and no later stage sees them.

use std::ops::Range;

use glam::{DQuat, DVec3};
use motiondb::diagnostic::Diagnostic;

use crate::error::RejectionReason;
use crate::read::axis::Axis;

/// Greatest number of joints of a clip; the largest rig of the development set, with face and fingers, has 165.
pub(crate) const MAX_JOINTS: usize = 4096;

/// Greatest number of frames of a clip: two hours at 30 Hz, 34 minutes at 120 Hz. The analysis of its gait takes up to
/// 9 KB a frame.
pub(crate) const MAX_FRAMES: usize = 250_000;
/// Greatest number of joint-frames of a clip, 1.1 GB: 80 joints in each of the most frames.
pub(crate) const MAX_JOINT_FRAMES: usize = 20_000_000;

/// An empty list with room for a number of values.
pub(crate) fn with_room<T>(count: usize) -> Result<Vec<T>, RejectionReason> {
    let mut values = Vec::new();
    let out_of_memory = |_| RejectionReason::OutOfMemory { mib: (count * size_of::<T>()) >> 20 };
    values.try_reserve_exact(count).map_err(out_of_memory)?;
    Ok(values)
}

/// One joint of a source skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceJoint {
    /// Name in the file. An end site has its parent's name with `_end` appended.
    pub name: String,
    /// Index of the parent, always smaller than the joint's own index.
    pub parent: Option<usize>,
    /// Whether this is an end site of a BVH file: a point without a rotation of its own.
    pub is_end: bool,
}

/// One clip of a file; nothing is known about its body yet.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceClip {
    /// File name without folders.
    pub file: String,
    /// Clip within the file; empty where the file holds one clip without a name.
    pub clip: String,
    /// All joints; each parent comes before its children.
    pub joints: Vec<SourceJoint>,
    /// Number of the file's frames before the first frame of this clip.
    pub first_frame: usize,
    /// Frame rate, Hz.
    pub frame_rate_hz: f64,
    /// Global positions, source units, at index frame · joint count + joint.
    pub positions: Vec<DVec3>,
    /// Global orientations, in the order of `positions`.
    pub orientations: Vec<DQuat>,
    /// Metres of one source unit, where the format (glTF: 1) or the manifest states it.
    pub metres_per_unit: Option<f64>,
    /// The axis that points up, where the manifest states it.
    pub up_axis: Option<Axis>,
    /// What the stages so far report of the clip.
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

    /// Removes all frames outside a range.
    pub fn keep_frames(&mut self, frames: Range<usize>) {
        self.first_frame += frames.start;
        let (first, last) = (frames.start * self.joints.len(), frames.end * self.joints.len());
        self.positions.truncate(last);
        self.orientations.truncate(last);
        self.positions.drain(..first);
        self.orientations.drain(..first);
    }
}

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

/// Greatest number of frames of a clip: two hours at 30 Hz, 34 minutes at 120 Hz. Import and
/// analysis take up to 2 KB a frame.
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
    /// The joints; each parent comes before its children.
    pub joints: Vec<SourceJoint>,
    /// Number of the file's frames before the first frame of this clip.
    pub first_frame: usize,
    /// Frame rate, Hz.
    pub frame_rate_hz: f64,
    /// Global positions, source units, at index frame · joint count + joint.
    pub positions: Vec<DVec3>,
    /// Number of joints, first ones, that have orientations: all of a whole clip.
    pub oriented: usize,
    /// Global orientations at index frame · `oriented` + joint.
    pub orientations: Vec<DQuat>,
    /// Metres of one source unit, where the format (glTF: 1) or the manifest states it.
    pub metres_per_unit: Option<f64>,
    /// The axis that points up, where the manifest states it.
    pub up_axis: Option<Axis>,
    /// What the stages so far report of the clip.
    pub diagnostics: Vec<Diagnostic>,
}

/// Joints that a clip keeps, in their new order.
pub(crate) struct KeptJoints {
    /// Joints with position and orientation.
    pub oriented: Vec<usize>,
    /// Joints with a position alone.
    pub points: Vec<usize>,
}

impl KeptJoints {
    /// All of so many joints.
    pub(crate) fn all(count: usize) -> Self {
        Self { oriented: (0..count).collect(), points: Vec::new() }
    }

    /// All joints in their new order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.oriented.iter().chain(&self.points).copied()
    }

    /// Number of joints.
    pub(crate) fn len(&self) -> usize {
        self.oriented.len() + self.points.len()
    }
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
        self.orientations[frame * self.oriented + joint]
    }

    /// Keeps some joints in all frames. A joint whose parent is left out, or comes later now, becomes a root.
    pub(crate) fn keep_joints(&mut self, kept: &KeptJoints) {
        let (count, oriented) = (self.joints.len(), self.oriented);
        let mut slots = vec![None; count];
        kept.iter().enumerate().for_each(|(slot, joint)| slots[joint] = Some(slot));
        let joint = |(slot, index): (usize, usize)| {
            let joint = &self.joints[index];
            let parent = joint.parent.and_then(|parent| slots[parent]).filter(|&parent| parent < slot);
            SourceJoint { parent, ..joint.clone() }
        };
        let frames = 0..self.frame_count();
        let of_frame = |frame: usize| kept.iter().map(move |joint| frame * count + joint);
        let positions = frames.clone().flat_map(of_frame).map(|index| self.positions[index]).collect();
        let of_frame = |frame: usize| kept.oriented.iter().map(move |&joint| frame * oriented + joint);
        let orientations = frames.flat_map(of_frame).map(|index| self.orientations[index]).collect();
        self.joints = kept.iter().enumerate().map(joint).collect();
        self.oriented = kept.oriented.len();
        (self.positions, self.orientations) = (positions, orientations);
    }

    /// Whether each joint is one of `joints` or above one.
    pub(crate) fn with_ancestors(&self, joints: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut is_marked = vec![false; self.joints.len()];
        joints.for_each(|joint| is_marked[joint] = true);
        // A parent comes before its children.
        for (joint, SourceJoint { parent, .. }) in self.joints.iter().enumerate().rev() {
            if let (true, Some(parent)) = (is_marked[joint], *parent) {
                is_marked[parent] = true;
            }
        }
        is_marked
    }

    /// Removes all frames outside a range.
    pub fn keep_frames(&mut self, frames: Range<usize>) {
        self.first_frame += frames.start;
        let (first, last) = (frames.start * self.joints.len(), frames.end * self.joints.len());
        self.positions.truncate(last);
        self.positions.drain(..first);
        let (first, last) = (frames.start * self.oriented, frames.end * self.oriented);
        self.orientations.truncate(last);
        self.orientations.drain(..first);
    }

    /// Removes the frames from one on, and gives their memory back.
    pub(crate) fn free_from(&mut self, frame: usize) {
        self.positions.truncate(frame * self.joints.len());
        self.positions.shrink_to_fit();
        self.orientations.truncate(frame * self.oriented);
        self.orientations.shrink_to_fit();
    }
}

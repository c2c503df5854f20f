//! A clip of which no frame is posed yet, so that the poses of all its joints never exist at once.
//!
//! The stages that look for the body need all joints in a few frames; those after them need all frames of a few joints.
//! Source units and axes.

use std::ops::Range;

use glam::{DQuat, DVec3};

use crate::error::RejectionReason;
use crate::read::source_clip::{KeptJoints, SourceClip, with_room};

/// Global positions and orientations of all joints in one frame.
pub(crate) struct JointPoses {
    pub positions: Vec<DVec3>,
    pub orientations: Vec<DQuat>,
}

/// Poses the frames of a file one by one.
pub(crate) trait FramePoser {
    /// Poses one frame. Joints that `is_needed` does not mark may keep any pose; a parent of a marked joint is marked.
    fn pose(&mut self, frame: usize, is_needed: &[bool], poses: &mut JointPoses);

    /// Poses all joints as the file's skeleton is at rest.
    fn pose_at_rest(&mut self, poses: &mut JointPoses);

    /// Frees what only frames before this one need.
    fn free_before(&mut self, _frame: usize) {}
}

/// A clip, and what poses its frames.
pub(crate) struct SourceMotion<'a> {
    /// The clip without its frames.
    pub head: SourceClip,
    /// Frames of the file that the clip has.
    frames: Range<usize>,
    poser: Box<dyn FramePoser + 'a>,
}

impl<'a> SourceMotion<'a> {
    /// The motion of a clip with the first `frames` frames that `poser` can pose.
    pub(crate) fn new(head: SourceClip, frames: usize, poser: impl FramePoser + 'a) -> Self {
        Self { head, frames: 0..frames, poser: Box::new(poser) }
    }

    /// Number of frames.
    pub(crate) fn frame_count(&self) -> usize {
        self.frames.len()
    }

    /// Removes all frames outside a range.
    pub(crate) fn keep_frames(&mut self, frames: Range<usize>) {
        self.head.first_frame += frames.start;
        self.frames = self.frames.start + frames.start..self.frames.start + frames.end;
    }

    /// All joints in some frames of the clip.
    pub(crate) fn sample(&mut self, frames: &[usize]) -> Result<SourceClip, RejectionReason> {
        let kept = KeptJoints::all(self.head.joints.len());
        let start = self.frames.start;
        let mut clip = self.empty_clip(&kept, frames.len())?;
        self.push_frames(&mut clip, &kept, frames.iter().map(|frame| start + frame), |_, _| ());
        Ok(clip)
    }

    /// All joints as the file's skeleton is at rest.
    pub(crate) fn rest(&mut self) -> JointPoses {
        let mut poses = self.origin();
        self.poser.pose_at_rest(&mut poses);
        poses
    }

    fn origin(&self) -> JointPoses {
        let count = self.head.joints.len();
        JointPoses { positions: vec![DVec3::ZERO; count], orientations: vec![DQuat::IDENTITY; count] }
    }

    /// Some joints in all frames of the clip. What a frame was read from is freed once it is posed.
    pub(crate) fn into_clip(mut self, kept: &KeptJoints) -> Result<SourceClip, RejectionReason> {
        let mut clip = self.empty_clip(kept, self.frames.len())?;
        let frames = self.frames.clone();
        self.push_frames(&mut clip, kept, frames, |poser, frame| poser.free_before(frame));
        Ok(clip)
    }

    /// All joints in all frames of the clip.
    pub(crate) fn into_whole_clip(self) -> Result<SourceClip, RejectionReason> {
        let kept = KeptJoints::all(self.head.joints.len());
        self.into_clip(&kept)
    }

    /// The clip of some joints, with room for so many frames.
    fn empty_clip(&self, kept: &KeptJoints, frames: usize) -> Result<SourceClip, RejectionReason> {
        let mut clip = self.head.clone();
        clip.keep_joints(kept);
        clip.positions = with_room(frames * kept.len())?;
        clip.orientations = with_room(frames * kept.oriented.len())?;
        Ok(clip)
    }

    /// Poses frames of the file, and appends some of their joints to a clip. `begin` is called before each frame.
    fn push_frames(
        &mut self,
        clip: &mut SourceClip,
        kept: &KeptJoints,
        frames: impl Iterator<Item = usize>,
        begin: impl Fn(&mut dyn FramePoser, usize),
    ) {
        let is_needed = self.head.with_ancestors(kept.iter());
        let mut poses = self.origin();
        for frame in frames {
            begin(self.poser.as_mut(), frame);
            self.poser.pose(frame, &is_needed, &mut poses);
            clip.positions.extend(kept.iter().map(|joint| poses.positions[joint]));
            clip.orientations.extend(kept.oriented.iter().map(|&joint| poses.orientations[joint]));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use super::*;
    use crate::read::source_clip::SourceJoint;

    /// Puts joint j of frame f at (f, j, 0), and records the frames whose input is freed.
    struct CountingPoser {
        freed: Rc<RefCell<Vec<usize>>>,
    }

    impl FramePoser for CountingPoser {
        fn pose(&mut self, frame: usize, is_needed: &[bool], poses: &mut JointPoses) {
            for joint in (0..is_needed.len()).filter(|&joint| is_needed[joint]) {
                poses.positions[joint] = DVec3::new(frame as f64, joint as f64, 0.0);
            }
        }

        fn pose_at_rest(&mut self, _: &mut JointPoses) {}

        fn free_before(&mut self, frame: usize) {
            self.freed.borrow_mut().push(frame);
        }
    }

    fn empty() -> SourceClip {
        SourceClip {
            file: String::new(),
            clip: String::new(),
            joints: Vec::new(),
            first_frame: 0,
            frame_rate_hz: 30.0,
            positions: Vec::new(),
            oriented: 0,
            orientations: Vec::new(),
            metres_per_unit: None,
            up_axis: None,
            diagnostics: Vec::new(),
        }
    }

    /// A chain of five joints in 100 frames, and the frames whose input is freed.
    fn chain() -> (SourceMotion<'static>, Rc<RefCell<Vec<usize>>>) {
        let parents = [None, Some(0), Some(1), Some(2), Some(3)];
        let joint = |parent| SourceJoint { name: String::new(), parent, is_end: false };
        let head = SourceClip { joints: parents.map(joint).to_vec(), ..empty() };
        let freed = Rc::new(RefCell::new(Vec::new()));
        (SourceMotion::new(head, 100, CountingPoser { freed: freed.clone() }), freed)
    }

    #[test]
    fn a_clip_holds_the_kept_joints_alone() {
        let (mut motion, freed) = chain();
        motion.keep_frames(10..90);
        let clip = motion.into_clip(&KeptJoints { oriented: vec![1, 3], points: vec![2] }).unwrap();
        assert_eq!((clip.frame_count(), clip.first_frame), (80, 10));
        assert_eq!((clip.positions.len(), clip.orientations.len()), (3 * 80, 2 * 80));
        assert_eq!((clip.positions.capacity(), clip.orientations.capacity()), (3 * 80, 2 * 80));
        assert_eq!([0, 1, 2].map(|joint| clip.position(7, joint).y), [1.0, 3.0, 2.0]);
        assert_eq!(clip.position(7, 0).x, 17.0);
        assert_eq!(*freed.borrow(), (10..90).collect::<Vec<usize>>());
    }

    #[test]
    fn a_sample_frees_nothing() {
        let (mut motion, freed) = chain();
        motion.keep_frames(10..90);
        let sample = motion.sample(&[0, 40]).unwrap();
        assert_eq!((sample.frame_count(), sample.joints.len()), (2, 5));
        assert_eq!([0, 1].map(|frame| sample.position(frame, 4).x), [10.0, 50.0]);
        assert!(freed.borrow().is_empty());
    }
}

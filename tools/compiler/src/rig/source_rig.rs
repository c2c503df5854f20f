//! A source skeleton as role finding looks at it: who hangs from whom, how far apart joints are, what their names hint
//! at; all geometry as means over frames spread over the clip. Source units.

use glam::DVec3;

use crate::read::source_clip::SourceClip;
use crate::rig::joint_names::{self, NameHints, Part};

/// Frames that geometry is judged on, spread over the clip.
const SAMPLES: usize = 48;

/// A skeleton with what role finding asks of it again and again.
pub(crate) struct Shape<'a> {
    pub clip: &'a SourceClip,
    pub hints: Vec<NameHints>,
    pub children: Vec<Vec<usize>>,
    frames: Vec<usize>,
    /// Along the bones from each joint to its farthest leaf.
    reach: Vec<f64>,
}

impl<'a> Shape<'a> {
    pub(crate) fn new(clip: &'a SourceClip) -> Self {
        let mut children = vec![Vec::new(); clip.joints.len()];
        for (index, joint) in clip.joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        let step = clip.frame_count().div_ceil(SAMPLES).max(1);
        let mut shape = Self {
            clip,
            hints: clip.joints.iter().map(|joint| joint_names::hints(&joint.name)).collect(),
            children,
            frames: (0..clip.frame_count()).step_by(step).collect(),
            reach: vec![0.0; clip.joints.len()],
        };
        for child in (0..clip.joints.len()).rev() {
            if let Some(parent) = clip.joints[child].parent {
                shape.reach[parent] = shape.reach[parent].max(shape.reach_through(parent, child));
            }
        }
        shape
    }

    fn reach_through(&self, parent: usize, child: usize) -> f64 {
        self.reach[child] + self.distance(parent, child)
    }

    /// Mean distance of two joints over the sampled frames.
    pub(crate) fn distance(&self, a: usize, b: usize) -> f64 {
        self.mean(|frame| (self.clip.position(frame, a) - self.clip.position(frame, b)).length())
    }

    /// Mean of a number over the sampled frames.
    pub(crate) fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.frames.iter().map(|&frame| value(frame)).sum::<f64>() / self.frames.len() as f64
    }

    /// Mean of a vector over the sampled frames.
    pub(crate) fn mean_vector(&self, value: impl Fn(usize) -> DVec3) -> DVec3 {
        self.frames.iter().map(|&frame| value(frame)).sum::<DVec3>() / self.frames.len() as f64
    }

    /// Standard deviation of a number over the sampled frames.
    pub(crate) fn deviation(&self, value: impl Fn(usize) -> f64) -> f64 {
        let mean = self.mean(&value);
        self.mean(|frame| (value(frame) - mean) * (value(frame) - mean)).sqrt()
    }

    /// Whether something holds in every sampled frame.
    pub(crate) fn always(&self, holds: impl Fn(usize) -> bool) -> bool {
        self.frames.iter().all(|&frame| holds(frame))
    }

    /// Standard deviation over mean of the distance of two joints: 0 for a bone.
    pub(crate) fn looseness(&self, a: usize, b: usize) -> f64 {
        let length = |frame: usize| (self.clip.position(frame, a) - self.clip.position(frame, b)).length();
        self.deviation(length) / self.mean(length).max(1e-12)
    }

    /// From a joint down to the leaf that is farthest along the bones, the joint included.
    pub(crate) fn chain(&self, joint: usize) -> Vec<usize> {
        let mut chain = vec![joint];
        let mut tail = joint;
        let through = |parent: usize, child: usize| self.reach_through(parent, child);
        while let Some(&next) =
            self.children[tail].iter().max_by(|&&a, &&b| through(tail, a).total_cmp(&through(tail, b)))
        {
            chain.push(next);
            tail = next;
        }
        chain
    }

    /// A joint and everything below it.
    pub(crate) fn subtree(&self, joint: usize) -> Vec<usize> {
        let mut members = vec![joint];
        let mut next = 0;
        while next < members.len() {
            members.extend(&self.children[members[next]]);
            next += 1;
        }
        members
    }

    /// A joint's ancestors, itself first, the root last.
    pub(crate) fn ancestors(&self, joint: usize) -> Vec<usize> {
        std::iter::successors(Some(joint), |&joint| self.clip.joints[joint].parent).collect()
    }

    pub(crate) fn says(&self, joint: usize, part: Part) -> bool {
        self.hints[joint].parts.contains(&part)
    }
}

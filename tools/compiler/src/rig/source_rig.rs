//! A source skeleton in the form that role search uses: hierarchy, names' hints, and geometry as means over sampled
//! frames.
//!
//! Lengths are in source units. Frames are spread evenly over the clip.

use glam::DVec3;

use crate::read::source_clip::SourceClip;
use crate::rig::joint_names::{self, BodyPart, NameHints};

/// Weights of a joint's name: the part that is sought, another part, a helper.
const NAME_WEIGHTS: [f64; 3] = [1.25, 0.6, 0.4];
/// Greatest number of frames on which geometry is measured.
const SAMPLES: usize = 48;
/// Number of joints above each joint to which its distance is measured once. Limb search asks for it hundreds of times.
pub(crate) const LEVELS_MAX: usize = 15;

/// The frames, of so many, on which geometry is measured.
pub(crate) fn sampled_frames(count: usize) -> Vec<usize> {
    (0..count).step_by(count.div_ceil(SAMPLES).max(1)).collect()
}

/// A source skeleton and what role search computes of it once.
pub(crate) struct SourceRig<'a> {
    pub clip: &'a SourceClip,
    /// Hints of each joint's name.
    pub hints: Vec<NameHints>,
    /// Weights of a name that is the part sought, another part, a helper.
    pub name_weights: [f64; 3],
    /// Children of each joint.
    pub children: Vec<Vec<usize>>,
    /// Frames on which geometry is measured.
    frames: Vec<usize>,
    /// Length along the bones from each joint to its farthest leaf.
    reach: Vec<f64>,
    /// Mean distance of each joint from its parent, the joint above that, and so on.
    distances_up: Vec<Vec<f64>>,
}

impl<'a> SourceRig<'a> {
    pub(crate) fn new(clip: &'a SourceClip) -> Self {
        let mut children = vec![Vec::new(); clip.joints.len()];
        for (index, joint) in clip.joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        let mut rig = Self {
            clip,
            hints: clip.joints.iter().map(|joint| joint_names::hints(&joint.name)).collect(),
            name_weights: NAME_WEIGHTS,
            children,
            frames: sampled_frames(clip.frame_count()),
            reach: vec![0.0; clip.joints.len()],
            distances_up: Vec::new(),
        };
        let distances_up = |joint: usize| {
            let above = rig.ancestors(joint).into_iter().skip(1).take(LEVELS_MAX);
            above.map(|above| rig.mean_distance(above, joint)).collect()
        };
        rig.distances_up = (0..clip.joints.len()).map(distances_up).collect();
        for child in (0..clip.joints.len()).rev() {
            if let Some(parent) = clip.joints[child].parent {
                rig.reach[parent] = rig.reach[parent].max(rig.reach_through(child));
            }
        }
        rig
    }

    fn reach_through(&self, child: usize) -> f64 {
        self.reach[child] + self.distance_up(child, 1)
    }

    /// Mean distance of a joint from the one so many levels above it, at most [`LEVELS_MAX`].
    pub(crate) fn distance_up(&self, joint: usize, levels: usize) -> f64 {
        self.distances_up[joint][levels - 1]
    }

    /// Mean distance of two joints.
    pub(crate) fn mean_distance(&self, a: usize, b: usize) -> f64 {
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

    /// Whether a condition holds in every sampled frame.
    pub(crate) fn always(&self, holds: impl Fn(usize) -> bool) -> bool {
        self.frames.iter().all(|&frame| holds(frame))
    }

    /// Standard deviation of the distance of two joints, divided by its mean; 0 for a rigid bone.
    pub(crate) fn looseness(&self, a: usize, b: usize) -> f64 {
        let length = |frame: usize| (self.clip.position(frame, a) - self.clip.position(frame, b)).length();
        self.deviation(length) / self.mean(length).max(1e-12)
    }

    /// The joints from `joint` to the leaf that is farthest along the bones.
    pub(crate) fn longest_chain(&self, joint: usize) -> Vec<usize> {
        let mut chain = vec![joint];
        let mut tail = joint;
        let through = |child: usize| self.reach_through(child);
        while let Some(&next) = self.children[tail].iter().max_by(|&&a, &&b| through(a).total_cmp(&through(b))) {
            chain.push(next);
            tail = next;
        }
        chain
    }

    /// A joint and all its descendants, level by level.
    pub(crate) fn subtree(&self, joint: usize) -> Vec<usize> {
        let mut members = vec![joint];
        let mut next = 0;
        while next < members.len() {
            members.extend(&self.children[members[next]]);
            next += 1;
        }
        members
    }

    /// The joints from `joint` to the root.
    pub(crate) fn ancestors(&self, joint: usize) -> Vec<usize> {
        std::iter::successors(Some(joint), |&joint| self.clip.joints[joint].parent).collect()
    }

    /// Whether the name of a joint hints at a part.
    pub(crate) fn hints_at(&self, joint: usize, part: BodyPart) -> bool {
        self.hints[joint].parts.contains(&part)
    }
}

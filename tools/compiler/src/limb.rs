//! Limbs of a source skeleton: pairs of chains, mirrored about the trunk, with two long bones each and a joint between.
//!
//! For a fork, every pair of children is tried; each child's chain is its longest path to a leaf. Along both chains
//! alike, the two bones are the longest triple i < j < k whose lengths are of like size and that skips only joints
//! lying on the bones themselves (twist bones, zero-length helpers). Names weigh in, so that an unnamed skeleton is
//! found by its shape and a named one in a stiff pose by its words.

use glam::DVec3;

use crate::joint_names::{NameHints, Part};
use crate::source_clip::SourceClip;

/// Frames that geometry is judged on, spread over the clip.
const SAMPLES: usize = 48;
/// Shank over thigh, forearm over upper arm: human 0.8–1.2, drawn characters up to 2.4 (`RobotExpressive.glb`).
const BONE_RATIO: std::ops::RangeInclusive<f64> = 0.45..=2.6;
/// How far a skipped joint may lie off its bone, over the bone's length.
const SKIPPED_OFF_BONE: f64 = 0.08;
/// How much two sides may differ in length (CMU's captured legs: 4 %).
const SIDES_DIFFER: f64 = 0.15;
/// Weight of a name that says this part; one that says another; a helper's.
const NAME_WEIGHTS: [f64; 3] = [1.25, 0.6, 0.4];
/// How much the distance from the knee to a foot outside the leg's chain may vary, over its mean.
const PARTED_FOOT_LOOSENESS: f64 = 0.12;
/// Joints from a fork to the end of its limb, helpers and fingers included: 9 in the busiest rig seen.
const LONGEST_CHAIN: usize = 16;
/// The depths of a limb that is on no chain.
const PARTED: [usize; 3] = [0; 3];
/// Weight of passing over a joint that is named as a part of a limb: not a twist bone (Bandai's `UpperArm` beside
/// `Shoulder`).
const SKIPPED_PART_WEIGHT: f64 = 0.5;

/// A skeleton with what role finding asks of it again and again.
pub(crate) struct Shape<'a> {
    pub clip: &'a SourceClip,
    pub hints: Vec<NameHints>,
    pub children: Vec<Vec<usize>>,
    frames: Vec<usize>,
    /// Along the bones from each joint to its farthest leaf.
    reach: Vec<f64>,
}

/// Three joints (hip, knee, ankle or shoulder, elbow, wrist) and the chain that they were found on.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    pub joints: [usize; 3],
    /// Places on the chain; both sides of a pair have the same.
    depths: [usize; 3],
    pub length: f64,
    pub score: f64,
}

/// Two limbs of one fork.
#[derive(Clone, Debug)]
pub(crate) struct LimbPair {
    pub fork: usize,
    pub limbs: [Limb; 2],
}

impl LimbPair {
    /// Limbs that need not be found, of the joint that both hang from.
    pub(crate) fn known(shape: &Shape, joints: [[usize; 3]; 2]) -> Self {
        let limbs = joints.map(|joints| {
            let [from, middle, to] = joints;
            let length = shape.distance(from, middle) + shape.distance(middle, to);
            Limb { joints, depths: PARTED, length, score: 0.0 }
        });
        let above = shape.ancestors(joints[1][0]);
        let fork = shape.ancestors(joints[0][0]).into_iter().find(|joint| above.contains(joint)).unwrap_or(0);
        Self { fork, limbs }
    }

    pub(crate) fn score(&self) -> f64 {
        self.limbs[0].score + self.limbs[1].score
    }
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
            hints: clip.joints.iter().map(|joint| crate::joint_names::hints(&joint.name)).collect(),
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

    /// Standard deviation over mean of the distance of two joints: 0 for a bone.
    pub(crate) fn looseness(&self, a: usize, b: usize) -> f64 {
        let mean = self.distance(a, b);
        let square = self.mean(|frame| {
            let length = (self.clip.position(frame, a) - self.clip.position(frame, b)).length();
            (length - mean) * (length - mean)
        });
        square.sqrt() / mean.max(1e-12)
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

    fn name_weight(&self, joint: usize, part: Part) -> f64 {
        let parts = &self.hints[joint].parts;
        let [agrees, differs, helper] = NAME_WEIGHTS;
        match parts {
            _ if parts.contains(&Part::Helper) => helper,
            _ if parts.contains(&part) => agrees,
            _ if parts.is_empty() => 1.0,
            _ => differs,
        }
    }

    fn skipped_weight(&self, chain: &[usize], joints: [usize; 3]) -> f64 {
        let names_a_part = |joint: usize| {
            let parts = &self.hints[joint].parts;
            !parts.is_empty() && !parts.contains(&Part::Helper)
        };
        let skipped = chain.iter().filter(|joint| !joints.contains(joint) && names_a_part(**joint));
        skipped.map(|_| SKIPPED_PART_WEIGHT).product()
    }

    /// The limb pair that best fits three parts, among forks and children that `allowed` lets through.
    pub(crate) fn best_pair(&self, parts: [Part; 3], allowed: impl Fn(usize) -> bool) -> Option<LimbPair> {
        let mut best: Option<LimbPair> = None;
        for fork in (0..self.children.len()).filter(|&fork| self.children[fork].len() > 1) {
            let branches: Vec<Vec<Limb>> = self.children[fork]
                .iter()
                .filter(|&&child| allowed(child))
                .map(|&child| self.limbs(child, parts))
                .collect();
            for pair in mirrored_pairs(fork, &branches) {
                // Of joints in one place the last carries the bend: a tie goes to it.
                let better = best.as_ref().is_none_or(|best| pair.score() >= best.score() * (1.0 - 1e-6));
                if better && self.on_both_sides(&pair) {
                    best = Some(pair);
                }
            }
        }
        best
    }

    /// A leg whose foot is no child of its shank: some rigs hang the feet, as targets of their leg IK, from the root
    /// (`RobotExpressive.glb`). Found by name and side, and by the knee's constant distance.
    fn limb_with_parted_foot(&self, thigh: usize, parts: [Part; 3]) -> Option<Limb> {
        let [first, second, last] = parts;
        let shank = *self.children[thigh].iter().find(|&&joint| self.hints[joint].parts == [second])?;
        if last != Part::Foot || !self.says(thigh, first) {
            return None;
        }
        let inside = self.subtree(thigh);
        let is_foot = |&joint: &usize| {
            self.hints[joint].parts == [last]
                && self.hints[joint].side == self.hints[shank].side
                && !inside.contains(&joint)
                && self.looseness(shank, joint) < PARTED_FOOT_LOOSENESS
        };
        let foot = (0..self.children.len()).find(is_foot)?;
        let length = self.distance(thigh, shank) + self.distance(shank, foot);
        let names: f64 =
            [thigh, shank, foot].iter().zip(parts).map(|(&joint, part)| self.name_weight(joint, part)).product();
        Some(Limb { joints: [thigh, shank, foot], depths: PARTED, length, score: length * names })
    }

    /// Whether the names put the two limbs on two sides, or say nothing of sides.
    fn on_both_sides(&self, pair: &LimbPair) -> bool {
        let [first, second] = pair.limbs.each_ref().map(|limb| self.hints[limb.joints[1]].side);
        first.is_none() == second.is_none() && (first.is_none() || first != second)
    }

    /// Every i < j < k on a child's chain that could be a limb.
    fn limbs(&self, child: usize, parts: [Part; 3]) -> Vec<Limb> {
        let mut chain = self.chain(child);
        chain.truncate(LONGEST_CHAIN);
        let mut limbs = Vec::from_iter(self.limb_with_parted_foot(child, parts));
        for end in 2..chain.len() {
            for middle in 1..end {
                limbs.extend((0..middle).filter_map(|start| self.limb(&chain, [start, middle, end], parts)));
            }
        }
        limbs
    }

    fn limb(&self, chain: &[usize], depths: [usize; 3], parts: [Part; 3]) -> Option<Limb> {
        let joints = depths.map(|depth| chain[depth]);
        let bones = [self.distance(joints[0], joints[1]), self.distance(joints[1], joints[2])];
        let [start, middle, end] = depths;
        let fits = BONE_RATIO.contains(&(bones[1] / bones[0].max(1e-12)))
            && self.skips_only_bone(&chain[start..=middle])
            && self.skips_only_bone(&chain[middle..=end]);
        let names: f64 = joints.iter().zip(parts).map(|(&joint, part)| self.name_weight(joint, part)).product();
        let length = bones[0] + bones[1];
        let score = length * names * self.skipped_weight(&chain[start..=end], joints);
        fits.then_some(Limb { joints, depths, length, score })
    }

    /// Whether all joints between the two ends lie on the line between them in every sampled frame.
    fn skips_only_bone(&self, chain: &[usize]) -> bool {
        let (Some(&first), Some(&last)) = (chain.first(), chain.last()) else { return true };
        let inner = &chain[1..chain.len() - 1];
        inner.is_empty()
            || self.frames.iter().all(|&frame| {
                let [start, end] = [first, last].map(|joint| self.clip.position(frame, joint));
                let bone = end - start;
                inner.iter().all(|&joint| {
                    let along = self.clip.position(frame, joint) - start;
                    let share = (along.dot(bone) / bone.length_squared().max(1e-24)).clamp(0.0, 1.0);
                    (along - share * bone).length() <= SKIPPED_OFF_BONE * bone.length()
                })
            })
    }
}

/// Limbs of two branches of a fork, at the same places of their chains and of like length.
fn mirrored_pairs(fork: usize, branches: &[Vec<Limb>]) -> impl Iterator<Item = LimbPair> {
    let alike = |first: &Limb, second: &Limb| {
        first.depths == second.depths
            && (first.length - second.length).abs() <= SIDES_DIFFER * first.length.max(second.length)
    };
    branches.iter().enumerate().flat_map(move |(index, branch)| {
        let others = branches[index + 1..].iter().flatten();
        let pairs = others.flat_map(move |second| branch.iter().map(move |first| (first, second)));
        let mirrored = pairs.filter(move |(first, second)| alike(first, second));
        mirrored.map(move |(first, second)| LimbPair { fork, limbs: [first.clone(), second.clone()] })
    })
}

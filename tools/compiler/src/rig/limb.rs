//! Limbs of a source skeleton: two long bones with a joint between them, and pairs of limbs that mirror each other.
//!
//! Candidates are all joints i < j < k on one path down from a child of a fork whose two bones are of similar length
//! and skip only joints that lie on the bones (twist bones, segments, zero-length helpers). Two candidates below
//! different children of a fork are a pair if their bones are alike. A pair's score is its length times weights of
//! names, so that shape finds an unnamed skeleton, and names find a skeleton in a stiff pose; an arm ends where fingers
//! begin. Lengths in source units.

use motiondb::body::Side;

use crate::rig::joint_names::{self, BodyPart};
use crate::rig::source_rig::{LEVELS_MAX, SourceRig};

/// Accepted length of the lower bone, divided by the upper one's: people 0.8 to 1.2, drawn characters up to 2.4.
const BONE_RATIO: std::ops::RangeInclusive<f64> = 0.45..=2.6;
/// Greatest distance of a skipped joint from its bone, divided by the bone's length.
const SKIPPED_OFF_BONE: f64 = 0.08;
/// Greatest difference of the two sides' bones, divided by the longer one; captured legs differ by 0.04.
const SIDES_DIFFER: f64 = 0.15;
/// Greatest standard deviation of the distance from the knee to a foot outside the leg's chain, divided by its mean.
const DETACHED_FOOT_LOOSENESS: f64 = 0.12;
/// Greatest number of joints from a fork to the end of its limb; the busiest rig of the development set has 9.
const MAX_CHAIN: usize = LEVELS_MAX + 1;
/// Greatest number of limbs of one fork that are paired, best first; a hand with all fingers has some dozens.
const MAX_LIMBS: usize = 256;
/// Greatest number of pairs of one fork, best first; no real rig has as many.
const MAX_PAIRS_OF_FORK: usize = 512;
/// Greatest number of pairs of all forks, best first; no real rig has as many.
const MAX_PAIRS: usize = 4096;
/// Weight of a limb that skips a joint whose name is another part, such as Bandai's `UpperArm` beside `Shoulder`.
const SKIPPED_PART_WEIGHT: f64 = 0.5;
/// Least number of chains of joints that hang from a hand: fingers.
const FINGERS_MIN: usize = 3;
/// Weight of an arm that does not end at such a hand, but beyond it.
const BEYOND_HAND_WEIGHT: f64 = 0.5;
/// Weight of a pair whose limbs have other numbers of joints above hip, knee or ankle: rigs are built alike on both
/// sides, and a fold of a cape beside an arm is not its mirror image.
const UNLIKE_CHAINS_WEIGHT: f64 = 0.6;
/// What each step down the chain adds to the score: of joints at one position the last one carries the bend.
const DEPTH_BONUS: f64 = 1e-7;

/// One limb.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    /// Hip, knee and ankle, or shoulder, elbow and wrist.
    pub joints: [usize; 3],
    /// Lengths of the upper and the lower bone.
    bones: [f64; 2],
    /// Length of both bones.
    pub length: f64,
    /// Length times weights.
    score: f64,
}

/// Two limbs that mirror each other.
#[derive(Clone, Debug)]
pub(crate) struct LimbPair {
    /// The joint from which both limbs hang.
    pub fork: usize,
    pub limbs: [Limb; 2],
}

impl Limb {
    fn new(rig: &SourceRig, joints: [usize; 3], weight: f64) -> Self {
        let [from, middle, to] = joints;
        Self::of_bones(joints, [rig.mean_distance(from, middle), rig.mean_distance(middle, to)], weight)
    }

    fn of_bones(joints: [usize; 3], bones: [f64; 2], weight: f64) -> Self {
        let length = bones[0] + bones[1];
        Self { joints, bones, length, score: length * weight }
    }

    fn is_like(&self, other: &Self) -> bool {
        let alike = |a: f64, b: f64| (a - b).abs() <= SIDES_DIFFER * a.max(b);
        alike(self.bones[0], other.bones[0]) && alike(self.bones[1], other.bones[1])
    }
}

impl LimbPair {
    /// The pair of known joints.
    pub(crate) fn known(rig: &SourceRig, joints: [[usize; 3]; 2]) -> Self {
        let limbs = joints.map(|joints| Limb::new(rig, joints, 1.0));
        let above = rig.ancestors(joints[1][0]);
        let fork = rig.ancestors(joints[0][0]).into_iter().find(|joint| above.contains(joint)).unwrap_or(0);
        Self { fork, limbs }
    }

    /// Sum of the limbs' scores.
    pub(crate) fn score(&self) -> f64 {
        self.limbs[0].score + self.limbs[1].score
    }

    /// Sides of the two limbs, by the first two joints whose names differ in a side.
    pub(crate) fn named_sides(&self, rig: &SourceRig) -> Option<[Side; 2]> {
        let [first, second] = self.limbs.each_ref().map(|limb| limb.joints);
        let name = |joint: usize| rig.clip.joints[joint].name.as_str();
        first.into_iter().zip(second).find_map(|(a, b)| joint_names::sides_by_difference(name(a), name(b)))
    }

    /// Whether names put both limbs on one side, as two fingers of a hand.
    fn is_on_one_side(&self, rig: &SourceRig) -> bool {
        let [first, second] = self.limbs.each_ref().map(|limb| rig.hints[limb.joints[1]].side);
        first.is_some() && first == second
    }
}

/// All pairs that may be three parts of the body, the best score first.
pub(crate) fn pairs(rig: &SourceRig, parts: [BodyPart; 3]) -> Vec<LimbPair> {
    let forks = (0..rig.children.len()).filter(|&fork| rig.children[fork].len() > 1);
    let mut pairs: Vec<LimbPair> = forks.flat_map(|fork| pairs_of_fork(rig, fork, parts)).collect();
    pairs.sort_by(|a, b| b.score().total_cmp(&a.score()));
    pairs.truncate(MAX_PAIRS);
    pairs
}

/// The pair whose score times its weight is greatest, and that product. `pairs` are sorted by score; a weight is at
/// most 1 and costly, so the search ends at the first pair whose score alone is too small.
pub(crate) fn best_weighted<'a>(
    pairs: impl IntoIterator<Item = &'a LimbPair>,
    weight: impl Fn(&LimbPair) -> f64,
) -> Option<(f64, &'a LimbPair)> {
    let mut best: Option<(f64, &LimbPair)> = None;
    for pair in pairs {
        let least = best.map_or(0.0, |(score, _)| score);
        if pair.score() <= least {
            break;
        }
        let score = pair.score() * weight(pair);
        if score > least {
            best = Some((score, pair));
        }
    }
    best
}

/// All pairs of one fork.
fn pairs_of_fork(rig: &SourceRig, fork: usize, parts: [BodyPart; 3]) -> Vec<LimbPair> {
    let children = rig.children[fork].iter().copied();
    let mut limbs: Vec<(usize, Limb)> =
        children.flat_map(|child| limbs_below(rig, child, parts).into_iter().map(move |limb| (child, limb))).collect();
    limbs.sort_by(|(_, a), (_, b)| b.score.total_cmp(&a.score));
    limbs.truncate(MAX_LIMBS);
    let mut slots: Vec<(usize, usize)> = (0..limbs.len())
        .flat_map(|first| (first + 1..limbs.len()).map(move |second| (first, second)))
        .filter(|&(first, second)| limbs[first].0 != limbs[second].0 && limbs[first].1.is_like(&limbs[second].1))
        .collect();
    let depths: Vec<[usize; 3]> =
        limbs.iter().map(|(_, limb)| limb.joints.map(|joint| rig.ancestors(joint).len())).collect();
    let weight =
        |(first, second): (usize, usize)| if depths[first] == depths[second] { 1.0 } else { UNLIKE_CHAINS_WEIGHT };
    let score = |&slots: &(usize, usize)| weight(slots) * (limbs[slots.0].1.score + limbs[slots.1].1.score);
    slots.sort_by(|a, b| score(b).total_cmp(&score(a)));
    slots.truncate(MAX_PAIRS_OF_FORK);
    let pair = |slots: (usize, usize)| {
        let limb = |slot: usize| Limb { score: weight(slots) * limbs[slot].1.score, ..limbs[slot].1.clone() };
        LimbPair { fork, limbs: [limb(slots.0), limb(slots.1)] }
    };
    slots.into_iter().map(pair).filter(|pair| !pair.is_on_one_side(rig)).collect()
}

/// All limbs on the paths down from a child of a fork.
fn limbs_below(rig: &SourceRig, child: usize, parts: [BodyPart; 3]) -> Vec<Limb> {
    let mut limbs = Vec::from_iter(limb_with_detached_foot(rig, child, parts));
    let mut paths = vec![vec![child]];
    while let Some(path) = paths.pop() {
        let end = path.len() - 1;
        for middle in 1..end {
            limbs.extend((0..middle).filter_map(|start| limb(rig, &path, [start, middle], parts)));
        }
        if path.len() < MAX_CHAIN {
            paths.extend(rig.children[path[end]].iter().map(|&next| [&path[..], &[next]].concat()));
        }
    }
    limbs
}

/// The limb from `start` over `middle` to the end of a path, if its bones fit.
fn limb(rig: &SourceRig, path: &[usize], [start, middle]: [usize; 2], parts: [BodyPart; 3]) -> Option<Limb> {
    let end = path.len() - 1;
    let joints = [path[start], path[middle], path[end]];
    let bones = [rig.distance_up(path[middle], middle - start), rig.distance_up(path[end], end - middle)];
    let [upper, lower] = [&path[start..=middle], &path[middle..]];
    let fits = BONE_RATIO.contains(&(bones[1] / bones[0].max(1e-12)))
        && skips_only_bone(rig, upper)
        && skips_only_bone(rig, lower);
    if !fits {
        return None;
    }
    let weight = skipped_weight(rig, upper)
        * skipped_weight(rig, lower)
        * beyond_hand_weight(rig, &path[start..end], parts)
        * (1.0 + DEPTH_BONUS * (start + middle) as f64);
    Some(Limb::of_bones(joints, bones, name_weight(rig, joints, parts) * weight))
}

/// A leg whose foot does not hang from its shank, by name, side and constant distance from the knee. Some rigs hang
/// feet from the root, as targets of leg IK.
fn limb_with_detached_foot(rig: &SourceRig, thigh: usize, parts: [BodyPart; 3]) -> Option<Limb> {
    let [first, second, last] = parts;
    let shank = *rig.children[thigh].iter().find(|&&joint| rig.hints[joint].parts == [second])?;
    if last != BodyPart::Foot || !rig.hints_at(thigh, first) {
        return None;
    }
    let inside = rig.subtree(thigh);
    if inside.iter().any(|&joint| rig.hints[joint].parts == [last]) {
        return None;
    }
    let is_foot = |&joint: &usize| {
        rig.hints[joint].parts == [last]
            && rig.hints[joint].side == rig.hints[shank].side
            && !inside.contains(&joint)
            && rig.looseness(shank, joint) < DETACHED_FOOT_LOOSENESS
    };
    let joints = [thigh, shank, (0..rig.children.len()).find(is_foot)?];
    Some(Limb::new(rig, joints, name_weight(rig, joints, parts)))
}

/// Product of the weights of three joints' names.
fn name_weight(rig: &SourceRig, joints: [usize; 3], parts: [BodyPart; 3]) -> f64 {
    let [agrees, differs, helper] = rig.name_weights;
    let weight = |(joint, part): (usize, BodyPart)| match &rig.hints[joint].parts {
        parts if parts.contains(&BodyPart::Helper) => helper,
        parts if parts.contains(&part) => agrees,
        parts if parts.is_empty() => 1.0,
        _ => differs,
    };
    joints.into_iter().zip(parts).map(weight).product()
}

/// Product of the weights of the joints within a bone. Helpers, and segments named as the bone's upper end, weigh 1.
fn skipped_weight(rig: &SourceRig, bone: &[usize]) -> f64 {
    let own = &rig.hints[bone[0]].parts;
    let is_part = |joint: &usize| {
        let parts = &rig.hints[*joint].parts;
        !parts.is_empty() && !parts.contains(&BodyPart::Helper) && parts != own
    };
    bone[1..bone.len() - 1].iter().filter(|joint| is_part(joint)).map(|_| SKIPPED_PART_WEIGHT).product()
}

/// Weight of an arm by the joints above its end: less where one of them has fingers.
fn beyond_hand_weight(rig: &SourceRig, above: &[usize], parts: [BodyPart; 3]) -> f64 {
    let chains = |joint: &usize| rig.children[*joint].iter().filter(|child| !rig.children[**child].is_empty()).count();
    let is_beyond = parts[2] == BodyPart::Hand && above.iter().any(|joint| chains(joint) >= FINGERS_MIN);
    if is_beyond { BEYOND_HAND_WEIGHT } else { 1.0 }
}

/// Whether all joints between the two ends lie on the line between them in every sampled frame.
fn skips_only_bone(rig: &SourceRig, bone: &[usize]) -> bool {
    let [first, inner @ .., last] = bone else { return true };
    inner.is_empty()
        || rig.always(|frame| {
            let [start, end] = [*first, *last].map(|joint| rig.clip.position(frame, joint));
            let bone = end - start;
            inner.iter().all(|&joint| {
                let along = rig.clip.position(frame, joint) - start;
                let share = (along.dot(bone) / bone.length_squared().max(1e-24)).clamp(0.0, 1.0);
                (along - share * bone).length() <= SKIPPED_OFF_BONE * bone.length()
            })
        })
}

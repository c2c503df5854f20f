//! Limbs of a source skeleton: two long bones with a joint between, and pairs of them mirrored about a fork.
//!
//! Below every child of a fork, any three joints i < j < k on one way down are a limb if their two bones are of like
//! size and pass over only joints that lie on the bones themselves (twist bones, segments, zero-length helpers). Two of
//! different children are a pair if their bones are alike. Names weigh in, so that an unnamed skeleton is found by its
//! shape and a named one in a stiff pose by its words.

use motiondb::body::Side;

use crate::rig::joint_names::{self, Part};
use crate::rig::source_rig::Shape;

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
/// Limbs of one fork that are paired, best first: a hand with all its fingers gives some dozens.
const MOST_LIMBS: usize = 256;
/// Pairs of one fork, and of all, that are looked at, best first: what no real rig reaches and no made-up one exceeds.
const MOST_PAIRS_OF_A_FORK: usize = 512;
const MOST_PAIRS: usize = 4096;
/// Weight of passing over a joint that is named as a part of a limb: not a twist bone (Bandai's `UpperArm` beside
/// `Shoulder`).
const SKIPPED_PART_WEIGHT: f64 = 0.5;
/// Of joints in one place the last carries the bend: what each step down the chain adds to the score.
const DEEPER: f64 = 1e-7;

/// Three joints (hip, knee, ankle or shoulder, elbow, wrist).
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    pub joints: [usize; 3],
    bones: [f64; 2],
    /// Of the two bones.
    pub length: f64,
    score: f64,
}

/// Two limbs of one fork.
#[derive(Clone, Debug)]
pub(crate) struct LimbPair {
    pub fork: usize,
    pub limbs: [Limb; 2],
}

impl Limb {
    fn new(shape: &Shape, joints: [usize; 3], weight: f64) -> Self {
        let [from, middle, to] = joints;
        let bones = [shape.distance(from, middle), shape.distance(middle, to)];
        let length = bones[0] + bones[1];
        Self { joints, bones, length, score: length * weight }
    }

    fn is_like(&self, other: &Self) -> bool {
        let alike = |a: f64, b: f64| (a - b).abs() <= SIDES_DIFFER * a.max(b);
        alike(self.bones[0], other.bones[0]) && alike(self.bones[1], other.bones[1])
    }
}

impl LimbPair {
    /// Limbs that need not be found, of the joint that both hang from.
    pub(crate) fn known(shape: &Shape, joints: [[usize; 3]; 2]) -> Self {
        let limbs = joints.map(|joints| Limb::new(shape, joints, 1.0));
        let above = shape.ancestors(joints[1][0]);
        let fork = shape.ancestors(joints[0][0]).into_iter().find(|joint| above.contains(joint)).unwrap_or(0);
        Self { fork, limbs }
    }

    pub(crate) fn score(&self) -> f64 {
        self.limbs[0].score + self.limbs[1].score
    }

    /// The sides of the two limbs by what their names differ in.
    pub(crate) fn named_sides(&self, shape: &Shape) -> Option<[Side; 2]> {
        let [first, second] = self.limbs.each_ref().map(|limb| limb.joints);
        let name = |joint: usize| shape.clip.joints[joint].name.as_str();
        first.into_iter().zip(second).find_map(|(a, b)| joint_names::sides(name(a), name(b)))
    }

    /// Whether both are named as of one side: two fingers, two folds of one sleeve.
    fn is_on_one_side(&self, shape: &Shape) -> bool {
        let [first, second] = self.limbs.each_ref().map(|limb| shape.hints[limb.joints[1]].side);
        first.is_some() && first == second
    }
}

/// All pairs that could play three parts, the longest and best named first.
pub(crate) fn pairs(shape: &Shape, parts: [Part; 3]) -> Vec<LimbPair> {
    let forks = (0..shape.children.len()).filter(|&fork| shape.children[fork].len() > 1);
    let mut pairs: Vec<LimbPair> = forks.flat_map(|fork| pairs_of(shape, fork, parts)).collect();
    pairs.sort_by(|a, b| b.score().total_cmp(&a.score()));
    pairs.truncate(MOST_PAIRS);
    pairs
}

/// The best of sorted pairs and its score, times a weight up to 1 that is costly to find.
pub(crate) fn best_of<'a>(
    pairs: impl IntoIterator<Item = &'a LimbPair>,
    weigh: impl Fn(&LimbPair) -> f64,
) -> Option<(f64, &'a LimbPair)> {
    let mut best: Option<(f64, &LimbPair)> = None;
    for pair in pairs {
        let least = best.map_or(0.0, |(score, _)| score);
        if pair.score() <= least {
            break;
        }
        let score = pair.score() * weigh(pair);
        if score > least {
            best = Some((score, pair));
        }
    }
    best
}

/// All pairs of one fork.
fn pairs_of(shape: &Shape, fork: usize, parts: [Part; 3]) -> Vec<LimbPair> {
    let children = shape.children[fork].iter().copied();
    let mut limbs: Vec<(usize, Limb)> = children
        .flat_map(|child| limbs_below(shape, child, parts).into_iter().map(move |limb| (child, limb)))
        .collect();
    limbs.sort_by(|(_, a), (_, b)| b.score.total_cmp(&a.score));
    limbs.truncate(MOST_LIMBS);
    let mut places: Vec<(usize, usize)> = (0..limbs.len())
        .flat_map(|first| (first + 1..limbs.len()).map(move |second| (first, second)))
        .filter(|&(first, second)| limbs[first].0 != limbs[second].0 && limbs[first].1.is_like(&limbs[second].1))
        .collect();
    let score = |&(first, second): &(usize, usize)| limbs[first].1.score + limbs[second].1.score;
    places.sort_by(|a, b| score(b).total_cmp(&score(a)));
    places.truncate(MOST_PAIRS_OF_A_FORK);
    let pair = |(first, second): (usize, usize)| [first, second].map(|place| limbs[place].1.clone());
    let pairs = places.into_iter().map(|places| LimbPair { fork, limbs: pair(places) });
    pairs.filter(|pair| !pair.is_on_one_side(shape)).collect()
}

/// Every i < j < k on a way down from a child that could be a limb.
fn limbs_below(shape: &Shape, child: usize, parts: [Part; 3]) -> Vec<Limb> {
    let mut limbs = Vec::from_iter(limb_with_parted_foot(shape, child, parts));
    let mut ways = vec![vec![child]];
    while let Some(way) = ways.pop() {
        let end = way.len() - 1;
        for middle in 1..end {
            limbs.extend((0..middle).filter_map(|start| limb(shape, &way, [start, middle], parts)));
        }
        if way.len() < LONGEST_CHAIN {
            ways.extend(shape.children[way[end]].iter().map(|&next| [&way[..], &[next]].concat()));
        }
    }
    limbs
}

/// The limb that ends where the way does.
fn limb(shape: &Shape, way: &[usize], [start, middle]: [usize; 2], parts: [Part; 3]) -> Option<Limb> {
    let joints = [way[start], way[middle], way[way.len() - 1]];
    let [upper, lower] = [&way[start..=middle], &way[middle..]];
    let weight = skipped_weight(shape, upper) * skipped_weight(shape, lower) * (1.0 + DEEPER * (start + middle) as f64);
    let limb = Limb::new(shape, joints, name_weight(shape, joints, parts) * weight);
    let fits = BONE_RATIO.contains(&(limb.bones[1] / limb.bones[0].max(1e-12)))
        && skips_only_bone(shape, upper)
        && skips_only_bone(shape, lower);
    fits.then_some(limb)
}

/// A leg whose foot is no child of its shank: some rigs hang the feet, as targets of their leg IK, from the root
/// (`RobotExpressive.glb`). Found by name and side, and by the knee's constant distance.
fn limb_with_parted_foot(shape: &Shape, thigh: usize, parts: [Part; 3]) -> Option<Limb> {
    let [first, second, last] = parts;
    let shank = *shape.children[thigh].iter().find(|&&joint| shape.hints[joint].parts == [second])?;
    if last != Part::Foot || !shape.says(thigh, first) {
        return None;
    }
    let inside = shape.subtree(thigh);
    if inside.iter().any(|&joint| shape.hints[joint].parts == [last]) {
        return None;
    }
    let is_foot = |&joint: &usize| {
        shape.hints[joint].parts == [last]
            && shape.hints[joint].side == shape.hints[shank].side
            && !inside.contains(&joint)
            && shape.looseness(shank, joint) < PARTED_FOOT_LOOSENESS
    };
    let joints = [thigh, shank, (0..shape.children.len()).find(is_foot)?];
    Some(Limb::new(shape, joints, name_weight(shape, joints, parts)))
}

fn name_weight(shape: &Shape, joints: [usize; 3], parts: [Part; 3]) -> f64 {
    let [agrees, differs, helper] = NAME_WEIGHTS;
    let weight = |(joint, part): (usize, Part)| match &shape.hints[joint].parts {
        parts if parts.contains(&Part::Helper) => helper,
        parts if parts.contains(&part) => agrees,
        parts if parts.is_empty() => 1.0,
        _ => differs,
    };
    joints.into_iter().zip(parts).map(weight).product()
}

/// Of the joints within a bone: helpers and segments of that bone, which are named as its upper end is, weigh nothing.
fn skipped_weight(shape: &Shape, bone: &[usize]) -> f64 {
    let own = &shape.hints[bone[0]].parts;
    let is_part = |joint: &usize| {
        let parts = &shape.hints[*joint].parts;
        !parts.is_empty() && !parts.contains(&Part::Helper) && parts != own
    };
    bone[1..bone.len() - 1].iter().filter(|joint| is_part(joint)).map(|_| SKIPPED_PART_WEIGHT).product()
}

/// Whether all joints between the two ends lie on the line between them in every sampled frame.
fn skips_only_bone(shape: &Shape, bone: &[usize]) -> bool {
    let [first, inner @ .., last] = bone else { return true };
    inner.is_empty()
        || shape.always(|frame| {
            let [start, end] = [*first, *last].map(|joint| shape.clip.position(frame, joint));
            let bone = end - start;
            inner.iter().all(|&joint| {
                let along = shape.clip.position(frame, joint) - start;
                let share = (along.dot(bone) / bone.length_squared().max(1e-24)).clamp(0.0, 1.0);
                (along - share * bone).length() <= SKIPPED_OFF_BONE * bone.length()
            })
        })
}

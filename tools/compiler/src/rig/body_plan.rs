//! Which pairs of limbs are legs and arms, and which of each pair is the left one, on a skeleton of any names.
//!
//! Legs reach lowest and begin at their fork. Arms are two thirds as long, hang from the upper trunk and bend; plaits,
//! wings and held things do not. Toes and knees point forward. Lengths in source units; directions in the source's
//! axes.

use glam::DVec3;
use motiondb::body::Side;

use crate::error::RejectionReason;
use crate::rig::joint_names::BodyPart;
use crate::rig::limb::{self, Limb, LimbPair};
use crate::rig::source_rig::SourceRig;

/// Parts of an arm.
const ARM_PARTS: [BodyPart; 3] = [BodyPart::UpperArm, BodyPart::Forearm, BodyPart::Hand];
/// Least number of a limb's three joints whose names make it an arm.
const NAMED_MIN: usize = 2;
/// Least weight of legs, for those that end a whole leg's length above another part of the body.
const HANGING_WEIGHT: f64 = 0.05;
/// Length of arms over legs. Drawn characters: 0.5 to 1.4 times this.
const ARM_OVER_LEG: f64 = 0.68;
/// Factor of the arms' length at which their weight falls to exp(−½).
const ARM_LENGTH_FACTOR: f64 = 1.6;
/// Height of the shoulders above the hips, divided by leg length. Drawn characters: 0.5 to 1.4 times this.
const SHOULDER_OVER_LEG: f64 = 0.6;
/// Deviation of the shoulders' height, in legs, at which the arms' weight falls to exp(−½).
const SHOULDER_DEVIATION: f64 = 0.5;
/// Least length of arms over legs: a shorter pair is a pair of fingers.
const ARM_OVER_LEG_MIN: f64 = 0.25;
/// Least score of legs, divided by the best legs' score.
const UNLIKELY: f64 = 0.1;
/// Distance of the hips from their fork, divided by the leg length, at which the legs' weight falls to exp(−½). People:
/// 0.1.
const HIP_FROM_FORK: f64 = 0.5;
/// Least standard deviation of an elbow's cosine. Plaits, wings and guns that are bound stiffly stay below.
const STIFF_COSINE: f64 = 1e-4;
/// Weight of a pair of limbs that do not bend.
const STIFF_WEIGHT: f64 = 0.4;
/// Least distance of a toe joint from the ankle, divided by half the leg, and of a foot's end, divided by the whole
/// leg.
pub(crate) const TOE_DISTANCE: f64 = 0.12;
/// Cosine below which toes, and also knees, contradict the sides that names state.
const CONTRADICTING_COSINE: f64 = -0.7;

/// Midpoint of the joints of a pair: 0 for hips or shoulders, 1 for knees or elbows, 2 for ankles or wrists.
pub(crate) fn middle(rig: &SourceRig, frame: usize, pair: &LimbPair, joint: usize) -> DVec3 {
    let [first, second] = pair.limbs.each_ref().map(|limb| rig.clip.position(frame, limb.joints[joint]));
    0.5 * (first + second)
}

/// Legs and arms: the two pairs that go together best, unless they are known.
///
/// # Errors
/// [`RejectionReason::NoLegs`], [`RejectionReason::NoArms`].
pub(crate) fn legs_and_arms(
    rig: &SourceRig,
    known_legs: Option<LimbPair>,
    known_arms: Option<LimbPair>,
) -> Result<[LimbPair; 2], RejectionReason> {
    let (known_legs, known_arms) = match (known_legs, known_arms) {
        (Some(legs), Some(arms)) => return Ok([legs, arms]),
        known => known,
    };
    let legs = match known_legs {
        Some(pair) => vec![(1.0, pair)],
        None => likely_legs(rig, limb::pairs(rig, [BodyPart::Thigh, BodyPart::Shank, BodyPart::Foot])),
    };
    let Some((_, likeliest)) = legs.first() else {
        return Err(RejectionReason::NoLegs);
    };
    let without_arms = reason_without_arms(rig, likeliest);
    let arms = known_arms.map_or_else(|| limb::pairs(rig, ARM_PARTS), |pair| vec![pair]);
    let mut best: Option<(f64, [LimbPair; 2])> = None;
    for (likelihood, legs) in legs {
        let Some((score, arms)) = best_arms(rig, &legs, &arms) else { continue };
        let score = likelihood * score * (0.5 + 0.5 * upright_cosine(rig, &legs, arms));
        if best.as_ref().is_none_or(|(least, _)| score > *least) {
            best = Some((score, [legs, arms.clone()]));
        }
    }
    best.map(|(_, limbs)| limbs).ok_or(without_arms)
}

/// Why a skeleton on which no arms go with the likeliest legs is refused: where names call these legs arms, it lacks legs.
fn reason_without_arms(rig: &SourceRig, likeliest: &LimbPair) -> RejectionReason {
    let is_named_arm = |limb: &Limb| {
        limb.joints.into_iter().zip(ARM_PARTS).filter(|&(joint, part)| rig.hints_at(joint, part)).count() >= NAMED_MIN
    };
    if likeliest.limbs.iter().all(is_named_arm) {
        return RejectionReason::NoLegs;
    }
    RejectionReason::NoArms { likeliest_legs: Box::new(likeliest.limbs.each_ref().map(|limb| end_names(rig, limb))) }
}

/// Names of a limb's first and last joint.
fn end_names(rig: &SourceRig, limb: &Limb) -> [String; 2] {
    [limb.joints[0], limb.joints[2]].map(|joint| rig.clip.joints[joint].name.clone())
}

/// The best legs of each two branches of a fork, with their likelihood: the score divided by the best score, times the
/// weight of how they stand.
fn likely_legs(rig: &SourceRig, pairs: Vec<LimbPair>) -> Vec<(f64, LimbPair)> {
    let mut likely: Vec<(f64, LimbPair)> = Vec::new();
    let best_score = pairs.first().map_or(1.0, LimbPair::score);
    for pair in pairs.into_iter().take_while(|pair| pair.score() > UNLIKELY * best_score) {
        let is_on_limb_of = |joint: usize, other: &LimbPair| {
            rig.ancestors(other.limbs[0].joints[2]).contains(&joint)
                || rig.ancestors(joint).contains(&other.limbs[0].joints[0])
        };
        if likely.iter().all(|(_, other)| !is_on_limb_of(pair.limbs[0].joints[1], other)) {
            likely.push((pair.score() / best_score * standing_weight(rig, &pair), pair));
        }
    }
    likely
}

/// The best arms beside these legs, and their weighted score.
fn best_arms<'a>(rig: &SourceRig, legs: &LimbPair, arms: &'a [LimbPair]) -> Option<(f64, &'a LimbPair)> {
    let taken: Vec<usize> = legs.limbs.iter().flat_map(|limb| rig.subtree(limb.joints[0])).collect();
    let above: Vec<usize> = legs.limbs.iter().flat_map(|limb| rig.ancestors(limb.joints[0])).collect();
    let is_free = |limb: &Limb| limb.joints.iter().all(|joint| !taken.contains(joint) && !above.contains(joint));
    let is_long = |pair: &&LimbPair| pair.limbs[0].length >= ARM_OVER_LEG_MIN * legs.limbs[0].length;
    let free = arms.iter().filter(is_long).filter(|pair| pair.limbs.iter().all(is_free));
    limb::best_weighted(free, |pair| arm_weight(rig, legs, pair))
}

/// Weight of legs: 1 where they begin at their fork, bend, and end lower than the rest of the body, seen from their
/// hips.
fn standing_weight(rig: &SourceRig, pair: &LimbPair) -> f64 {
    let up = rig.mean_vector(|frame| middle(rig, frame, pair, 0) - middle(rig, frame, pair, 2));
    let up = up.normalize_or_zero();
    let own = pair.limbs.each_ref().map(|limb| rig.subtree(limb.joints[1]));
    let above = rig.ancestors(pair.fork);
    let is_other = |joint: &usize| !above.contains(joint) && own.iter().all(|own| !own.contains(joint));
    let others: Vec<usize> = (0..rig.children.len()).filter(is_other).collect();
    let lowest = |frame: usize, joints: &[usize]| {
        joints.iter().map(|&joint| rig.clip.position(frame, joint).dot(up)).fold(f64::INFINITY, f64::min)
    };
    let length = pair.limbs[0].length.max(1e-12);
    let height_over_others = |own: &[usize]| rig.mean(|frame| (lowest(frame, own) - lowest(frame, &others)).max(0.0));
    let gap = f64::max(height_over_others(&own[0]), height_over_others(&own[1])) / length;
    let from_fork = rig.mean_distance(pair.fork, pair.limbs[0].joints[0]) / length / HIP_FROM_FORK;
    (1.0 - gap).max(HANGING_WEIGHT) * libm::exp(-0.5 * (from_fork * from_fork)) * bending_weight(rig, pair)
}

/// Weight of arms: 1 where they are as long as arms, begin at the height of shoulders, and bend.
fn arm_weight(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> f64 {
    let leg = legs.limbs[0].length.max(1e-12);
    let up = legs_up(rig, legs).normalize_or_zero();
    let height = rig.mean(|frame| (middle(rig, frame, arms, 0) - middle(rig, frame, legs, 0)).dot(up)) / leg;
    let ratio = arms.limbs[0].length / leg;
    let length_off = libm::log((ratio / ARM_OVER_LEG).max(1e-12)) / libm::log(ARM_LENGTH_FACTOR);
    let height_off = (height - SHOULDER_OVER_LEG) / SHOULDER_DEVIATION;
    // Scores grow with length. A limb that is longer than an arm is not a better arm.
    let length_correction = (ARM_OVER_LEG / ratio.max(1e-12)).min(1.0);
    let off = length_off * length_off + height_off * height_off;
    length_correction * libm::exp(-0.5 * off) * bending_weight(rig, arms)
}

/// Weight of a pair of limbs: 1 where either one bends.
fn bending_weight(rig: &SourceRig, pair: &LimbPair) -> f64 {
    let is_stiff = |limb: &Limb| {
        let cosine = |frame: usize| {
            let [from, middle, to] = limb.joints.map(|joint| rig.clip.position(frame, joint));
            (middle - from).normalize_or_zero().dot((to - middle).normalize_or_zero())
        };
        rig.deviation(cosine) < STIFF_COSINE
    };
    if pair.limbs.iter().all(is_stiff) { STIFF_WEIGHT } else { 1.0 }
}

/// Mean cosine between the legs' mean direction (toes → hips) and the trunk (hips → shoulders).
pub(crate) fn upright_cosine(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> f64 {
    let legs_up = legs_up(rig, legs).normalize_or_zero();
    rig.mean(|frame| legs_up.dot((middle(rig, frame, arms, 0) - middle(rig, frame, legs, 0)).normalize_or_zero()))
}

/// Mean vector from the toes to the hips.
fn legs_up(rig: &SourceRig, legs: &LimbPair) -> DVec3 {
    let tips = legs.limbs.each_ref().map(|limb| toe_tip(rig, limb));
    let toes = |frame: usize| 0.5 * tips.map(|tip| rig.clip.position(frame, tip)).into_iter().sum::<DVec3>();
    rig.mean_vector(|frame| middle(rig, frame, legs, 0) - toes(frame))
}

/// Sides of a pair of legs.
pub(crate) struct LegSides {
    /// Whether the first leg is the right one.
    pub are_swapped: bool,
    /// Whether toes and knees contradict the sides that names state.
    pub contradict_names: bool,
}

/// Sides of the legs: by names, unless toes and knees both point backward, as in a mirrored file. Without names, left
/// is the direction of up × forward.
pub(crate) fn leg_sides(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> LegSides {
    let tips = legs.limbs.each_ref().map(|limb| toe_tip(rig, limb));
    let by_toes = leftness(rig, legs, arms, |frame, leg| toe_direction(rig, frame, &legs.limbs[leg], tips[leg]));
    let Some(named) = legs.named_sides(rig) else {
        return LegSides { are_swapped: by_toes < 0.0, contradict_names: false };
    };
    let by_knees = leftness(rig, legs, arms, |frame, leg| knee_direction(rig, frame, &legs.limbs[leg]));
    let sign = if named[0] == Side::Left { 1.0 } else { -1.0 };
    let contradict_names = sign * by_toes < CONTRADICTING_COSINE && sign * by_knees < CONTRADICTING_COSINE;
    LegSides { are_swapped: (named[0] == Side::Right) != contradict_names, contradict_names }
}

/// Whether the first leg of a pair, stated as the left one, stands on the right: the feet point backward.
pub(crate) fn are_feet_backward(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> bool {
    let tips = legs.limbs.each_ref().map(|limb| toe_tip(rig, limb));
    leftness(rig, legs, arms, |frame, leg| toe_direction(rig, frame, &legs.limbs[leg], tips[leg]))
        < CONTRADICTING_COSINE
}

/// Cosine between up × forward and the line from the second to the first leg: 1 where the first leg is the left one.
/// `forward` is the forward direction of a frame and a leg.
fn leftness(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair, forward: impl Fn(usize, usize) -> DVec3) -> f64 {
    let left = |frame: usize| {
        let up = middle(rig, frame, arms, 0) - middle(rig, frame, legs, 2);
        up.normalize_or_zero().cross(forward(frame, 0) + forward(frame, 1))
    };
    let [first, second] = legs.limbs.each_ref().map(|limb| limb.joints[0]);
    let across =
        |frame: usize| (rig.clip.position(frame, first) - rig.clip.position(frame, second)).normalize_or_zero();
    let along = rig.mean(|frame| left(frame).dot(across(frame)));
    along / rig.mean(|frame| left(frame).length()).max(1e-12)
}

/// Whether the first arm is on the side of the second leg.
pub(crate) fn are_arms_swapped(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> bool {
    let across = |frame: usize, pair: &LimbPair| {
        rig.clip.position(frame, pair.limbs[0].joints[0]) - rig.clip.position(frame, pair.limbs[1].joints[0])
    };
    rig.mean(|frame| across(frame, legs).dot(across(frame, arms))) < 0.0
}

/// The joint of a foot that is farthest from the ankle; the ankle where the foot has no other joint.
fn toe_tip(rig: &SourceRig, limb: &Limb) -> usize {
    farthest_below(rig, limb.joints[2], limb.length, |_| true).unwrap_or(limb.joints[2])
}

/// Vector from the ankle to the end of the foot; the knee's direction where there is no foot.
fn toe_direction(rig: &SourceRig, frame: usize, limb: &Limb, tip: usize) -> DVec3 {
    let [ankle, end] = [limb.joints[2], tip].map(|joint| rig.clip.position(frame, joint));
    if (end - ankle).length() > TOE_DISTANCE * limb.length { end - ankle } else { knee_direction(rig, frame, limb) }
}

/// Vector from the leg's line to the knee.
fn knee_direction(rig: &SourceRig, frame: usize, limb: &Limb) -> DVec3 {
    let [hip, knee, ankle] = limb.joints.map(|joint| rig.clip.position(frame, joint));
    knee - 0.5 * (hip + ankle)
}

/// The descendant that is farthest away, but no farther than `reach`, among those that `counts` accepts; none where all
/// are at the joint itself.
pub(crate) fn farthest_below(
    rig: &SourceRig,
    from: usize,
    reach: f64,
    counts: impl Fn(usize) -> bool,
) -> Option<usize> {
    let below = rig.subtree(from).into_iter().skip(1).filter(|&joint| counts(joint));
    let distances = below.map(|joint| (joint, rig.mean_distance(from, joint)));
    let near = distances.filter(|&(_, distance)| (1e-9..=reach).contains(&distance));
    near.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(joint, _)| joint)
}

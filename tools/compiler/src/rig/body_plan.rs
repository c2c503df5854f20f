//! What tells legs from wings, arms from plaits and left from right on a skeleton whose names say nothing: legs reach
//! lowest, arms are two thirds as long, hang from the upper trunk and bend, toes and knees point forward.

use glam::DVec3;
use motiondb::body::Side;

use crate::error::Refusal;
use crate::rig::joint_names::Part;
use crate::rig::limb::{self, Limb, LimbPair};
use crate::rig::source_rig::Shape;

/// Weight of legs under which another part of the body reaches a whole leg's length lower.
const HANGING_WEIGHT: f64 = 0.05;
/// Arms over legs, shoulder over hips in legs: people's; and the factor at which either becomes improbable (drawn
/// characters: 0.5 to 1.4 of it).
const ARM_OVER_LEG: f64 = 0.68;
const SHOULDER_OVER_LEG: f64 = 0.6;
const ARM_LENGTH_FACTOR: f64 = 1.6;
const SHOULDER_DEVIATION: f64 = 0.5;
/// The shortest arms, over the legs: what is shorter is a pair of fingers.
const ARM_OVER_LEG_MIN: f64 = 0.25;
/// Legs of a score under this share of the longest limbs' are none.
const UNLIKELY: f64 = 0.1;
/// Hips from their fork, over the leg, at which legs become improbable (people: 0.1).
const HIP_FROM_FORK: f64 = 0.5;
/// An elbow whose cosine varies less than this is no joint (plaits, wings and guns that are bound stiffly), and the
/// weight of such a limb.
const STIFF_COSINE: f64 = 1e-4;
const STIFF_WEIGHT: f64 = 0.4;
/// Standard deviation of the place of whoever makes a way, over the leg: a straight way of a leg's length.
const WAY_MIN: f64 = 0.3;
/// A toe joint is at least this share of the shank away from the ankle.
pub(crate) const TOE_DISTANCE: f64 = 0.12;
/// Cosine past which toes, and also knees, belie the sides that names give.
const BELIED_COSINE: f64 = -0.7;

/// Midpoint of the joints of a pair.
pub(crate) fn middle(shape: &Shape, frame: usize, pair: &LimbPair, joint: usize) -> DVec3 {
    let [first, second] = pair.limbs.each_ref().map(|limb| shape.clip.position(frame, limb.joints[joint]));
    0.5 * (first + second)
}

/// The pairs of a body: of all legs and arms those that go together best.
///
/// # Errors
/// What is missing.
pub(crate) fn find(
    shape: &Shape,
    known_legs: Option<LimbPair>,
    known_arms: Option<LimbPair>,
) -> Result<[LimbPair; 2], Refusal> {
    let (known_legs, known_arms) = match (known_legs, known_arms) {
        (Some(legs), Some(arms)) => return Ok([legs, arms]),
        known => known,
    };
    let legs = match known_legs {
        Some(pair) => vec![(1.0, pair)],
        None => likely_legs(shape, limb::pairs(shape, [Part::Thigh, Part::Shank, Part::Foot])),
    };
    let Some((_, likeliest)) = legs.first() else {
        return Err(Refusal::NoLegs);
    };
    let seeming_legs = likeliest.limbs.each_ref().map(|limb| ends(shape, limb));
    let arms =
        known_arms.map_or_else(|| limb::pairs(shape, [Part::UpperArm, Part::Forearm, Part::Hand]), |pair| vec![pair]);
    let mut best: Option<(f64, [LimbPair; 2])> = None;
    for (likelihood, legs) in legs {
        let Some((score, arms)) = best_arms(shape, &legs, &arms) else { continue };
        let score = likelihood * score * (0.5 + 0.5 * upright_cosine(shape, &legs, arms));
        if best.as_ref().is_none_or(|(least, _)| score > *least) {
            best = Some((score, [legs, arms.clone()]));
        }
    }
    best.map(|(_, body)| body).ok_or(Refusal::NoArms { seeming_legs })
}

/// Names of a limb's first and last joint.
fn ends(shape: &Shape, limb: &Limb) -> [String; 2] {
    [limb.joints[0], limb.joints[2]].map(|joint| shape.clip.joints[joint].name.clone())
}

/// The best legs of every two branches of a fork, with their scores over the best of all.
fn likely_legs(shape: &Shape, pairs: Vec<LimbPair>) -> Vec<(f64, LimbPair)> {
    let mut likely: Vec<(f64, LimbPair)> = Vec::new();
    let longest = pairs.first().map_or(1.0, LimbPair::score);
    for pair in pairs.into_iter().take_while(|pair| pair.score() > UNLIKELY * longest) {
        let share = |joint: usize, other: &LimbPair| {
            shape.ancestors(other.limbs[0].joints[2]).contains(&joint)
                || shape.ancestors(joint).contains(&other.limbs[0].joints[0])
        };
        if likely.iter().all(|(_, other)| !share(pair.limbs[0].joints[1], other)) {
            likely.push((pair.score() / longest * standing_weight(shape, &pair), pair));
        }
    }
    likely
}

/// The best arms beside legs.
fn best_arms<'a>(shape: &Shape, legs: &LimbPair, arms: &'a [LimbPair]) -> Option<(f64, &'a LimbPair)> {
    let taken: Vec<usize> = legs.limbs.iter().flat_map(|limb| shape.subtree(limb.joints[0])).collect();
    let above: Vec<usize> = legs.limbs.iter().flat_map(|limb| shape.ancestors(limb.joints[0])).collect();
    let is_free = |limb: &Limb| limb.joints.iter().all(|joint| !taken.contains(joint) && !above.contains(joint));
    let long_enough = |pair: &&LimbPair| pair.limbs[0].length >= ARM_OVER_LEG_MIN * legs.limbs[0].length;
    let free = arms.iter().filter(long_enough).filter(|pair| pair.limbs.iter().all(is_free));
    limb::best_of(free, |pair| arm_weight(shape, legs, pair))
}

/// 1 for limbs that begin at their fork, bend, and end lower than all else of the body, seen from where they begin.
fn standing_weight(shape: &Shape, pair: &LimbPair) -> f64 {
    let up = shape.mean_vector(|frame| middle(shape, frame, pair, 0) - middle(shape, frame, pair, 2));
    let up = up.normalize_or_zero();
    let own = pair.limbs.each_ref().map(|limb| shape.subtree(limb.joints[1]));
    let above = shape.ancestors(pair.fork);
    let is_other = |joint: &usize| !above.contains(joint) && own.iter().all(|own| !own.contains(joint));
    let others: Vec<usize> = (0..shape.children.len()).filter(is_other).collect();
    let lowest = |frame: usize, joints: &[usize]| {
        joints.iter().map(|&joint| shape.clip.position(frame, joint).dot(up)).fold(f64::INFINITY, f64::min)
    };
    let length = pair.limbs[0].length.max(1e-12);
    let over = |own: &[usize]| shape.mean(|frame| (lowest(frame, own) - lowest(frame, &others)).max(0.0));
    let gap = f64::max(over(&own[0]), over(&own[1])) / length;
    let apart = shape.distance(pair.fork, pair.limbs[0].joints[0]) / length;
    (1.0 - gap).max(HANGING_WEIGHT) * libm::exp(-0.5 * (apart / HIP_FROM_FORK).powi(2)) * bending_weight(shape, pair)
}

/// 1 for limbs as long as arms, beginning where shoulders are, that bend.
fn arm_weight(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> f64 {
    let leg = legs.limbs[0].length.max(1e-12);
    let up = legs_up(shape, legs).normalize_or_zero();
    let height = shape.mean(|frame| (middle(shape, frame, arms, 0) - middle(shape, frame, legs, 0)).dot(up)) / leg;
    let ratio = arms.limbs[0].length / leg;
    let length_off = libm::log((ratio / ARM_OVER_LEG).max(1e-12)) / libm::log(ARM_LENGTH_FACTOR);
    let height_off = (height - SHOULDER_OVER_LEG) / SHOULDER_DEVIATION;
    // The search ranks by length; beyond its due a longer limb is not a better arm.
    let due = (ARM_OVER_LEG / ratio.max(1e-12)).min(1.0);
    let off = length_off * length_off + height_off * height_off;
    due * libm::exp(-0.5 * off) * bending_weight(shape, arms)
}

/// 1 for limbs with a joint that bends, of either side.
fn bending_weight(shape: &Shape, pair: &LimbPair) -> f64 {
    let is_stiff = |limb: &Limb| {
        let cosine = |frame: usize| {
            let [from, middle, to] = limb.joints.map(|joint| shape.clip.position(frame, joint));
            (middle - from).normalize_or_zero().dot((to - middle).normalize_or_zero())
        };
        shape.deviation(cosine) < STIFF_COSINE
    };
    if pair.limbs.iter().all(is_stiff) { STIFF_WEIGHT } else { 1.0 }
}

/// Mean cosine between the legs' mean direction (toes → hips) and the trunk (hips → shoulders).
pub(crate) fn upright_cosine(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> f64 {
    let legs_up = legs_up(shape, legs).normalize_or_zero();
    shape.mean(|frame| legs_up.dot((middle(shape, frame, arms, 0) - middle(shape, frame, legs, 0)).normalize_or_zero()))
}

/// How much of the way that a body makes, where it makes one, lies along its own length, from feet to shoulders: 1 for
/// people who crawl, swim or climb.
pub(crate) fn share_along_itself(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> f64 {
    let hips = |frame: usize| middle(shape, frame, legs, 0);
    let centre = shape.mean_vector(hips);
    let length = shape.mean_vector(|frame| middle(shape, frame, arms, 0) - middle(shape, frame, legs, 2));
    let length = length.normalize_or_zero();
    let way = shape.mean(|frame| (hips(frame) - centre).length_squared()).sqrt();
    let along = shape.mean(|frame| (hips(frame) - centre).dot(length).powi(2)).sqrt();
    if way > WAY_MIN * legs.limbs[0].length { along / way } else { 0.0 }
}

/// From the toes to the hips, on the average.
pub(crate) fn legs_up(shape: &Shape, legs: &LimbPair) -> DVec3 {
    let tips = legs.limbs.each_ref().map(|limb| toe_tip(shape, limb));
    let toes = |frame: usize| 0.5 * tips.map(|tip| shape.clip.position(frame, tip)).into_iter().sum::<DVec3>();
    shape.mean_vector(|frame| middle(shape, frame, legs, 0) - toes(frame))
}

/// Whether the legs stand as right, left, and whether their names say otherwise than toes and knees do.
///
/// By names where they say, unless toes and knees both point the other way: then the file is mirrored. Without names,
/// left is where up × forward points.
pub(crate) fn legs_swapped(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> (bool, bool) {
    let tips = legs.limbs.each_ref().map(|limb| toe_tip(shape, limb));
    let by_toes = leftness(shape, legs, arms, |frame, side| toe_direction(shape, frame, &legs.limbs[side], tips[side]));
    let Some(named) = legs.named_sides(shape) else { return (by_toes < 0.0, false) };
    let by_knees = leftness(shape, legs, arms, |frame, side| knee_direction(shape, frame, &legs.limbs[side]));
    let sign = if named[0] == Side::Left { 1.0 } else { -1.0 };
    let belied = sign * by_toes < BELIED_COSINE && sign * by_knees < BELIED_COSINE;
    ((named[0] == Side::Right) != belied, belied)
}

/// Cosine between up × forward and the line from the second to the first leg: 1 where the first is the left one.
fn leftness(shape: &Shape, legs: &LimbPair, arms: &LimbPair, forward: impl Fn(usize, usize) -> DVec3) -> f64 {
    let left = |frame: usize| {
        let up = middle(shape, frame, arms, 0) - middle(shape, frame, legs, 2);
        up.normalize_or_zero().cross(forward(frame, 0) + forward(frame, 1))
    };
    let [first, second] = legs.limbs.each_ref().map(|limb| limb.joints[0]);
    let across =
        |frame: usize| (shape.clip.position(frame, first) - shape.clip.position(frame, second)).normalize_or_zero();
    let along = shape.mean(|frame| left(frame).dot(across(frame)));
    along / shape.mean(|frame| left(frame).length()).max(1e-12)
}

/// Arms without sides in their names lie on the side of the leg that is nearer in the pelvis–chest frame: across the
/// same way.
pub(crate) fn arms_swapped(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> bool {
    let across = |frame: usize, pair: &LimbPair| {
        shape.clip.position(frame, pair.limbs[0].joints[0]) - shape.clip.position(frame, pair.limbs[1].joints[0])
    };
    shape.mean(|frame| across(frame, legs).dot(across(frame, arms))) < 0.0
}

/// The joint of a foot that is farthest from the ankle; the ankle where there is none.
fn toe_tip(shape: &Shape, limb: &Limb) -> usize {
    farthest(shape, limb.joints[2], limb.length, |_| true).unwrap_or(limb.joints[2])
}

/// From the ankle to the end of the foot, or, where there is no foot, as the knee does.
fn toe_direction(shape: &Shape, frame: usize, limb: &Limb, tip: usize) -> DVec3 {
    let [ankle, end] = [limb.joints[2], tip].map(|joint| shape.clip.position(frame, joint));
    if (end - ankle).length() > TOE_DISTANCE * limb.length { end - ankle } else { knee_direction(shape, frame, limb) }
}

/// The way the knee points off the leg's line.
fn knee_direction(shape: &Shape, frame: usize, limb: &Limb) -> DVec3 {
    let [hip, knee, ankle] = limb.joints.map(|joint| shape.clip.position(frame, joint));
    knee - 0.5 * (hip + ankle)
}

/// The joint below (or an end site) that is farthest away, if it is away at all, yet no farther than `reach`.
pub(crate) fn farthest(shape: &Shape, from: usize, reach: f64, counts: impl Fn(usize) -> bool) -> Option<usize> {
    let below = shape.subtree(from).into_iter().skip(1).filter(|&joint| counts(joint));
    let distances = below.map(|joint| (joint, shape.distance(from, joint)));
    let near = distances.filter(|&(_, distance)| (1e-9..=reach).contains(&distance));
    near.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(joint, _)| joint)
}

//! Legs beyond the two of a human body: of spiders, centaurs and robots with many legs.
//!
//! At rest, hands hang high above the ankles. A pair of limbs that comes down to the ankles, away from
//! the legs' own feet, stands on the ground: the arms that the search found, limbs that begin away from the hips, and
//! limbs that names call legs. Skirts, coats and plaits come down to the ankles, too, but begin at the hips or above.

use glam::DVec3;
use motiondb::body::Joint;

use crate::rig::body_plan::middle;
use crate::rig::joint_names::BodyPart;
use crate::rig::limb::{self, Limb, LimbPair};
use crate::rig::roles::{ARMS, LEGS, Roles};
use crate::rig::source_rig::SourceRig;

/// Parts of a leg.
const LEG_PARTS: [BodyPart; 3] = [BodyPart::Thigh, BodyPart::Shank, BodyPart::Foot];
/// Height of a limb's end above the ankles, divided by that of the hips, up to which the limb stands. Hands that hang on
/// short legs: 0.7.
const STANDING: f64 = 0.2;
/// Distance of a limb's end from both ankles along the ground, over the height of the hips, from which it is another foot.
const APART: f64 = 0.25;
/// Distance of a limb's beginning from the middle of the hips along the ground, over the height of the hips, from which it
/// hangs from another part of the body. Skirts: 0.3.
const AWAY: f64 = 0.5;
/// Greatest height of a leg's beginning over the hips or under them, over their height. Shoulders: 0.6, controls of feet: 1.
const BEGINNING: f64 = 0.45;
/// Least cosine between the legs' mean direction and the vertical of a body that stands. Hind legs of ten that splay: 0.44.
const UPRIGHT_COSINE: f64 = 0.3;

/// Names of the uppermost joints of a pair of limbs that stands on the ground beside the legs. `vertical` is upwards in a
/// scene where the body stands.
pub(crate) fn surplus_legs(rig: &SourceRig, roles: &Roles, vertical: DVec3) -> Option<[String; 2]> {
    let of_roles =
        |limbs: [[Joint; 3]; 2]| LimbPair::known(rig, limbs.map(|limb| limb.map(|joint| roles.required(joint))));
    let (legs, arms) = (of_roles(LEGS), of_roles(ARMS));
    let stance = Stance::new(rig, &legs, vertical);
    let of_legs: Vec<usize> = legs.limbs.iter().flat_map(|limb| rig.subtree(limb.joints[0])).collect();
    let is_free =
        |pair: &LimbPair| pair.limbs.iter().all(|limb| limb.joints.iter().all(|joint| !of_legs.contains(joint)));
    let others = limb::pairs(rig, LEG_PARTS).into_iter().filter(|pair| is_free(pair));
    let is_leg = |pair: &LimbPair| stance.begins_as_legs(pair) && (is_named_leg(rig, pair) || stance.begins_away(pair));
    let surplus = std::iter::once(arms).chain(others.filter(is_leg)).find(|pair| stance.stands(pair))?;
    Some(surplus.limbs.map(|limb| rig.clip.joints[limb.joints[0]].name.clone()))
}

/// Whether names make both limbs legs.
fn is_named_leg(rig: &SourceRig, pair: &LimbPair) -> bool {
    let is_named = |limb: &Limb| limb.joints.into_iter().zip(LEG_PARTS).all(|(joint, part)| rig.hints_at(joint, part));
    pair.limbs.iter().all(is_named)
}

/// How a body stands on its legs. Heights and distances are divided by the height of the hips above the ankles.
struct Stance<'a> {
    rig: &'a SourceRig<'a>,
    legs: &'a LimbPair,
    /// Unit vector upwards.
    up: DVec3,
    hips_over_ankles: f64,
}

impl<'a> Stance<'a> {
    /// `vertical` is upwards where the body stands; a body that lies has its legs' direction.
    fn new(rig: &'a SourceRig<'a>, legs: &'a LimbPair, vertical: DVec3) -> Self {
        let of_legs = rig.mean_vector(|frame| middle(rig, frame, legs, 0) - middle(rig, frame, legs, 2));
        let is_upright = of_legs.dot(vertical) > UPRIGHT_COSINE * of_legs.length();
        let up = if is_upright { vertical } else { of_legs.normalize_or_zero() };
        Self { rig, legs, up, hips_over_ankles: of_legs.dot(up).max(1e-12) }
    }

    /// Height of a joint above another one.
    fn height(&self, joint: usize, other: usize) -> f64 {
        self.offset(joint, other).dot(self.up) / self.hips_over_ankles
    }

    /// Distance of two joints along the ground.
    fn distance(&self, joint: usize, other: usize) -> f64 {
        let offset = self.offset(joint, other);
        (offset - offset.dot(self.up) * self.up).length() / self.hips_over_ankles
    }

    fn offset(&self, joint: usize, other: usize) -> DVec3 {
        self.rig.mean_vector(|frame| self.rig.clip.position(frame, joint) - self.rig.clip.position(frame, other))
    }

    /// Whether a condition holds of two joints, each beside a joint of each leg.
    fn holds(&self, own: [usize; 2], of_leg: usize, condition: impl Fn(usize, usize) -> bool) -> bool {
        own.into_iter().all(|own| self.legs.limbs.iter().all(|leg| condition(own, leg.joints[of_leg])))
    }

    /// The lowest joint of a limb's end and below it: a horse's leg has five joints.
    fn lowest(&self, limb: &Limb) -> usize {
        let height = |joint: &usize| self.height(*joint, limb.joints[2]);
        let below = self.rig.subtree(limb.joints[2]).into_iter();
        below.min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(limb.joints[2])
    }

    /// Whether a pair stands on the ground, apart from the ankles.
    fn stands(&self, pair: &LimbPair) -> bool {
        let stands = |end, ankle| self.height(end, ankle) < STANDING && self.distance(end, ankle) > APART;
        self.holds(pair.limbs.each_ref().map(|limb| self.lowest(limb)), 2, stands)
    }

    /// Whether a pair begins as high as legs do.
    fn begins_as_legs(&self, pair: &LimbPair) -> bool {
        self.holds(beginnings(pair), 0, |from, hip| self.height(from, hip).abs() < BEGINNING)
    }

    /// Whether a pair begins away from the hips.
    fn begins_away(&self, pair: &LimbPair) -> bool {
        self.holds(beginnings(pair), 0, |from, hip| self.distance(from, hip) > AWAY)
    }
}

/// The joints with which the limbs of a pair begin.
fn beginnings(pair: &LimbPair) -> [usize; 2] {
    pair.limbs.each_ref().map(|limb| limb.joints[0])
}

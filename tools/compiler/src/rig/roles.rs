//! Automatic joint roles: which source joint plays which canonical one, by hierarchy, geometry and name; and the
//! refusal, with its reason, of what is no human body.
//!
//! Legs and arms are the two limb pairs that go together best (`body_plan`); the pelvis is the legs' fork, the chest
//! the arms' fork, the spine the path between them; neck and head hang from the chest beside the arms. Left and right
//! come from names unless toes and knees belie them; without names from where the toes point. A body is human when its
//! trunk stands over its legs (a quadruped's does not) and its way does not lie along its own length.

use motiondb::body::{JOINT_COUNT, Joint, Side};

use crate::error::{Refusal, Setting};
use crate::input::clip_settings::JointMap;
use crate::read::source_clip::SourceClip;
use crate::rig::body_plan::{self, TOE_DISTANCE, farthest, middle};
use crate::rig::joint_names::Part;
use crate::rig::limb::{Limb, LimbPair};
use crate::rig::source_rig::Shape;
use crate::rig::two_bodies;

/// Least mean cosine between the legs' mean direction (toes → hips) and the trunk (hips → shoulders). People walk and
/// run at 0.9–1, crouch and bow at 0.64; a fox walks at 0.1 and gallops at 0.28.
const UPRIGHT_COSINE: f64 = 0.45;
/// Whose way lies along the line from feet to shoulders (cosine of 37°) does not walk; stairs: 0.6, bent double: 0.65.
const ALONG_ITSELF_MAX: f64 = 0.8;
/// Fingertips are at most this share of the arm from the wrist (people 0.33), toe tips this share of the leg from the
/// ball: what is farther off is held or worn.
const HAND_REACH: f64 = 0.6;
const FOOT_REACH: f64 = 0.4;
/// More joints than any rig with face and fingers (165 in the development set).
pub(crate) const MAX_JOINTS: usize = 4096;
/// Knees and elbows are bones' ends: their bones' lengths vary less than this (translating knees of `misc/ezgi_walk1`:
/// 5 %).
const LOOSE_BONE: f64 = 0.15;

/// The roles of the limbs, from the trunk outwards, `[left, right]`.
pub(crate) const LEGS: [[Joint; 3]; 2] =
    [[Joint::LeftThigh, Joint::LeftShank, Joint::LeftFoot], [Joint::RightThigh, Joint::RightShank, Joint::RightFoot]];
/// As [`LEGS`].
pub(crate) const ARMS: [[Joint; 3]; 2] = [
    [Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand],
    [Joint::RightUpperArm, Joint::RightForearm, Joint::RightHand],
];

/// Source joints by canonical role.
#[derive(Clone, Debug, PartialEq)]
pub struct Roles {
    /// The source joint that turns as the canonical one does; none where the source has no such joint.
    pub joints: [Option<usize>; JOINT_COUNT],
    /// The far end of head, hands and toes, where the source has one.
    pub ends: [Option<usize>; JOINT_COUNT],
    /// `[left, right]`: heel, ball and toe-tip joints on the sole, where the clip carries `…Sole` joints.
    pub soles: [Option<[usize; 3]>; 2],
    /// `[left, right]`: the heel's own joint, where the clip has one.
    pub heels: [Option<usize>; 2],
    /// Names call left what stands on the right: the file is mirrored, and sides are as the body stands.
    pub names_belied: bool,
}

impl Roles {
    /// The source joint of a role that [`find_roles`] never leaves out (pelvis, thigh, shank, foot, upper arm, forearm,
    /// hand).
    pub fn required(&self, joint: Joint) -> usize {
        self.joints[joint.index()].expect("find_roles assigns it or refuses the clip")
    }

    /// Left becomes right.
    pub(crate) fn exchange_sides(&mut self) {
        let mirrored = |found: &[Option<usize>; JOINT_COUNT]| Joint::ALL.map(|joint| found[joint.mirrored().index()]);
        (self.joints, self.ends) = (mirrored(&self.joints), mirrored(&self.ends));
        self.soles.swap(0, 1);
        self.heels.swap(0, 1);
    }
}

/// Finds the roles of a clip's joints, apart from those that are known: of legs and arms all six joints or none.
///
/// # Errors
/// [`Refusal`] for what has no human legs, no arms, or does not stand upright, or is known wrongly.
pub fn find_roles(clip: &SourceClip, known: &JointMap) -> Result<Roles, Refusal> {
    if known.iter().all(Option::is_none) {
        two_bodies::refuse(clip)?;
    }
    let found = find_by_names(clip, known);
    // Names that stand twice were copied from one side to the other: the shape alone may tell more.
    if found.is_err() && has_doubled_names(clip) {
        return find_by_names(&two_bodies::nameless(clip), known).or(found);
    }
    found
}

fn has_doubled_names(clip: &SourceClip) -> bool {
    let mut names: Vec<&str> = clip.joints.iter().filter(|joint| !joint.is_end).map(|joint| &*joint.name).collect();
    names.retain(|name| !name.is_empty());
    names.sort_unstable();
    names.windows(2).any(|pair| pair[0] == pair[1])
}

/// One try; [`Refusal`] as [`find_roles`].
pub(crate) fn find_by_names(clip: &SourceClip, known: &JointMap) -> Result<Roles, Refusal> {
    if clip.joints.len() > MAX_JOINTS {
        return Err(Refusal::TooManyJoints { count: clip.joints.len() });
    }
    let shape = Shape::new(clip);
    let (known_legs, known_arms) = (known_pair(&shape, known, LEGS)?, known_pair(&shape, known, ARMS)?);
    let [mut legs, mut arms] = body_plan::find(&shape, known_legs.clone(), known_arms.clone())?;
    if known_legs.is_none() {
        check_bones(&shape, &legs)?;
    }
    check_upright(&shape, &legs, &arms)?;
    let (swapped, belied) = body_plan::legs_swapped(&shape, &legs, &arms);
    if known_legs.is_none() && swapped {
        legs.limbs.swap(0, 1);
    }
    if known_arms.is_none() && body_plan::arms_swapped(&shape, &legs, &arms) {
        arms.limbs.swap(0, 1);
    }
    let mut roles = Roles {
        joints: [None; JOINT_COUNT],
        ends: [None; JOINT_COUNT],
        soles: [None; 2],
        heels: [None; 2],
        names_belied: known_legs.is_none() && belied,
    };
    assign_limbs(&shape, &mut roles, &legs, &arms);
    assign_trunk(&shape, &mut roles, &legs, &arms);
    for (role, known) in roles.joints.iter_mut().zip(known) {
        *role = known.or(*role);
    }
    Ok(roles)
}

/// The pair whose six joints are known.
fn known_pair(shape: &Shape, known: &JointMap, roles: [[Joint; 3]; 2]) -> Result<Option<LimbPair>, Refusal> {
    let mut joints = [[0; 3]; 2];
    for (joint, role) in joints.as_flattened_mut().iter_mut().zip(roles.as_flattened()) {
        let Some(known) = known[role.index()] else { return Ok(None) };
        *joint = known;
    }
    for (limb, roles) in joints.iter().zip(roles) {
        for bone in 0..2 {
            let [above, below] = [limb[bone], limb[bone + 1]];
            if above == below || !shape.ancestors(below).contains(&above) {
                let [above, below] = [above, below].map(|joint| &shape.clip.joints[joint].name);
                let reason = format!("`{below}` does not hang from `{above}` in {}", shape.clip.file);
                let remedy = "follow each limb from the trunk outwards";
                return Err(Refusal::Setting { setting: Setting::Joint(roles[bone + 1]), reason, remedy });
            }
        }
    }
    Ok(Some(LimbPair::known(shape, joints)))
}

fn check_bones(shape: &Shape, legs: &LimbPair) -> Result<(), Refusal> {
    for limb in &legs.limbs {
        let [hip, knee, ankle] = limb.joints;
        if shape.looseness(hip, knee).max(shape.looseness(knee, ankle)) > LOOSE_BONE {
            return Err(Refusal::LooseLeg { knee: shape.clip.joints[knee].name.clone() });
        }
    }
    Ok(())
}

fn check_upright(shape: &Shape, legs: &LimbPair, arms: &LimbPair) -> Result<(), Refusal> {
    let cosine = body_plan::upright_cosine(shape, legs, arms);
    if cosine < UPRIGHT_COSINE {
        return Err(Refusal::NotUpright { trunk_deg: libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees() });
    }
    if body_plan::share_along_itself(shape, legs, arms) > ALONG_ITSELF_MAX {
        return Err(Refusal::MovesAlongItself);
    }
    Ok(())
}

fn assign_limbs(shape: &Shape, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    const CLAVICLES: [Joint; 2] = [Joint::LeftClavicle, Joint::RightClavicle];
    for side in Side::BOTH.map(Side::index) {
        for bone in 0..3 {
            roles.joints[LEGS[side][bone].index()] = Some(legs.limbs[side].joints[bone]);
            roles.joints[ARMS[side][bone].index()] = Some(arms.limbs[side].joints[bone]);
        }
        let shoulder = arms.limbs[side].joints[0];
        let above = shape.ancestors(shoulder).into_iter().skip(1).take_while(|&joint| joint != arms.fork).last();
        roles.joints[CLAVICLES[side].index()] = above;
        let hand = arms.limbs[side].joints[2];
        roles.ends[ARMS[side][2].index()] =
            farthest(shape, hand, HAND_REACH * arms.limbs[side].length, |joint| !shape.says(joint, Part::Helper));
        assign_foot(shape, roles, side, &legs.limbs[side]);
    }
}

fn assign_foot(shape: &Shape, roles: &mut Roles, side: usize, leg: &Limb) {
    let ankle = leg.joints[2];
    let below: Vec<usize> = shape.subtree(ankle).into_iter().skip(1).collect();
    let says = |joint: usize, word: &str| shape.clip.joints[joint].name.to_lowercase().contains(word);
    roles.soles[side] = soles(shape, &below);
    roles.heels[side] = below.iter().copied().find(|&joint| says(joint, "heel") && !shape.says(joint, Part::Helper));
    let on_foot = |joint: &usize| !shape.says(*joint, Part::Helper) && !says(*joint, "heel") && !says(*joint, "sole");
    let far = |joint: &usize| shape.distance(ankle, *joint) > TOE_DISTANCE * 0.5 * leg.length;
    let toe = below.iter().copied().find(|joint| on_foot(joint) && far(joint));
    let Some(toe) = toe else { return };
    roles.joints[Joint::TOES[side].index()] = Some(toe);
    roles.ends[Joint::TOES[side].index()] = farthest(shape, toe, FOOT_REACH * leg.length, |joint| on_foot(&joint));
}

/// Leaf joints named `…Sole` for heel, ball and toe tip.
fn soles(shape: &Shape, foot: &[usize]) -> Option<[usize; 3]> {
    let named = |word: &str| {
        foot.iter().copied().find(|&joint| {
            let name = shape.clip.joints[joint].name.to_lowercase();
            name.contains("sole") && name.contains(word) && !shape.clip.joints[joint].is_end
        })
    };
    Some([named("heel")?, named("ball")?, named("toe")?])
}

fn assign_trunk(shape: &Shape, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    roles.joints[Joint::Pelvis.index()] = Some(legs.fork);
    let pelvis_line = shape.ancestors(legs.fork);
    let mut spine: Vec<usize> =
        shape.ancestors(arms.fork).into_iter().take_while(|joint| !pelvis_line.contains(joint)).collect();
    spine.reverse();
    if let [lower, between @ .., upper] = spine.as_slice() {
        roles.joints[Joint::SpineLower.index()] = Some(*lower);
        roles.joints[Joint::SpineUpper.index()] = Some(*upper);
        roles.joints[Joint::SpineMiddle.index()] = between.get(between.len() / 2).copied();
    } else if let [upper] = spine.as_slice() {
        roles.joints[Joint::SpineUpper.index()] = Some(*upper);
    }
    assign_head(shape, roles, legs, arms);
}

/// The branch beside the arms that a name calls neck or head, else the one that rises highest.
fn assign_head(shape: &Shape, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    let taken: Vec<usize> =
        arms.limbs.iter().chain(&legs.limbs).flat_map(|limb| shape.ancestors(limb.joints[0])).collect();
    let up =
        shape.mean_vector(|frame| middle(shape, frame, arms, 0) - middle(shape, frame, legs, 0)).normalize_or_zero();
    let rise = |joint: usize| {
        shape.mean(|frame| (shape.clip.position(frame, joint) - shape.clip.position(frame, arms.fork)).dot(up))
    };
    let named =
        |chain: &Vec<usize>| chain.iter().any(|&joint| shape.says(joint, Part::Neck) || shape.says(joint, Part::Head));
    let chains =
        shape.children[arms.fork].iter().filter(|child| !taken.contains(child)).map(|&child| head_chain(shape, child));
    let height = |chain: &Vec<usize>| chain.last().map_or(f64::MIN, |&joint| rise(joint));
    let Some(chain) = chains.max_by(|a, b| named(a).cmp(&named(b)).then(height(a).total_cmp(&height(b)))) else {
        return;
    };
    let turning: Vec<usize> = chain.iter().copied().filter(|&joint| !shape.clip.joints[joint].is_end).collect();
    let named_head = turning.iter().copied().find(|&joint| shape.says(joint, Part::Head));
    let Some(head) = named_head.or(turning.get(1).copied()).or(turning.first().copied()) else { return };
    roles.joints[Joint::Head.index()] = Some(head);
    roles.joints[Joint::Neck.index()] = turning.first().copied().filter(|&neck| neck != head);
}

/// Down to the head where a name says so, else the longest chain.
fn head_chain(shape: &Shape, child: usize) -> Vec<usize> {
    match shape.subtree(child).into_iter().find(|&joint| shape.says(joint, Part::Head)) {
        Some(head) => {
            let mut chain: Vec<usize> = shape.ancestors(head);
            chain.truncate(1 + chain.iter().position(|&joint| joint == child).unwrap_or(0));
            chain.reverse();
            chain
        }
        None => shape.chain(child),
    }
}

//! Legs and arms → the roles of all other joints.
//!
//! The pelvis is the legs' fork, the chest the arms' fork, the spine the path between them. Neck and head hang from the
//! chest beside the arms. Clavicles lie between the chest and the arms; toes, heels and soles hang from the ankles.

use motiondb::body::{JOINT_COUNT, Joint, Side};

use crate::rig::body_plan::{TOE_DISTANCE, farthest_below, middle};
use crate::rig::joint_names::BodyPart;
use crate::rig::limb::{Limb, LimbPair};
use crate::rig::roles::{ARMS, LEGS, Roles};
use crate::rig::source_rig::SourceRig;

/// Greatest distance of the fingertips from the wrist, divided by the arm length. People: 0.33. A farther joint is a
/// held thing.
const HAND_REACH: f64 = 0.6;
/// Greatest distance of the toe tip from the ball, divided by the leg length. A farther joint is a worn thing.
const FOOT_REACH: f64 = 0.4;

/// Roles of a body with these limbs, `[left, right]`.
pub(crate) fn assigned_roles(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> Roles {
    let mut roles = Roles {
        joints: [None; JOINT_COUNT],
        ends: [None; JOINT_COUNT],
        soles: [None; 2],
        heels: [None; 2],
        extra: Vec::new(),
        are_names_mirrored: false,
    };
    assign_limbs(rig, &mut roles, legs, arms);
    assign_trunk(rig, &mut roles, legs, arms);
    assign_head(rig, &mut roles, legs, arms);
    roles
}

fn assign_limbs(rig: &SourceRig, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    const CLAVICLES: [Joint; 2] = [Joint::LeftClavicle, Joint::RightClavicle];
    for side in Side::BOTH.map(Side::index) {
        for bone in 0..3 {
            roles.joints[LEGS[side][bone].index()] = Some(legs.limbs[side].joints[bone]);
            roles.joints[ARMS[side][bone].index()] = Some(arms.limbs[side].joints[bone]);
        }
        let shoulder = arms.limbs[side].joints[0];
        let above = rig.ancestors(shoulder).into_iter().skip(1).take_while(|&joint| joint != arms.fork).last();
        roles.joints[CLAVICLES[side].index()] = above;
        let hand = arms.limbs[side].joints[2];
        roles.ends[ARMS[side][2].index()] = farthest_below(rig, hand, HAND_REACH * arms.limbs[side].length, |joint| {
            !rig.hints_at(joint, BodyPart::Helper)
        });
        assign_foot(rig, roles, side, &legs.limbs[side]);
    }
}

fn assign_foot(rig: &SourceRig, roles: &mut Roles, side: usize, leg: &Limb) {
    let ankle = leg.joints[2];
    let below: Vec<usize> = rig.subtree(ankle).into_iter().skip(1).collect();
    let is_named = |joint: usize, word: &str| rig.clip.joints[joint].name.to_lowercase().contains(word);
    let is_helper = |joint: usize| rig.hints_at(joint, BodyPart::Helper);
    roles.soles[side] = sole_joints(rig, &below);
    roles.heels[side] = below.iter().copied().find(|&joint| is_named(joint, "heel") && !is_helper(joint));
    let is_of_forefoot = |joint: usize| !is_helper(joint) && !is_named(joint, "heel") && !is_named(joint, "sole");
    let is_far = |joint: usize| rig.mean_distance(ankle, joint) > TOE_DISTANCE * 0.5 * leg.length;
    let toe = below.iter().copied().find(|&joint| is_of_forefoot(joint) && is_far(joint));
    let Some(toe) = toe else { return };
    roles.joints[Joint::TOES[side].index()] = Some(toe);
    roles.ends[Joint::TOES[side].index()] = farthest_below(rig, toe, FOOT_REACH * leg.length, is_of_forefoot);
}

/// Heel, ball and toe tip on the sole: joints named `…Sole`.
fn sole_joints(rig: &SourceRig, foot: &[usize]) -> Option<[usize; 3]> {
    let named = |word: &str| {
        foot.iter().copied().find(|&joint| {
            let name = rig.clip.joints[joint].name.to_lowercase();
            name.contains("sole") && name.contains(word) && !rig.clip.joints[joint].is_end
        })
    };
    Some([named("heel")?, named("ball")?, named("toe")?])
}

fn assign_trunk(rig: &SourceRig, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    roles.joints[Joint::Pelvis.index()] = Some(legs.fork);
    let pelvis_line = rig.ancestors(legs.fork);
    let mut spine: Vec<usize> =
        rig.ancestors(arms.fork).into_iter().take_while(|joint| !pelvis_line.contains(joint)).collect();
    spine.reverse();
    if let [lower, between @ .., upper] = spine.as_slice() {
        roles.joints[Joint::SpineLower.index()] = Some(*lower);
        roles.joints[Joint::SpineUpper.index()] = Some(*upper);
        roles.joints[Joint::SpineMiddle.index()] = between.get(between.len() / 2).copied();
    } else if let [upper] = spine.as_slice() {
        roles.joints[Joint::SpineUpper.index()] = Some(*upper);
    }
}

/// Neck and head: on the branch beside the arms that a name calls neck or head, else on the branch that rises highest.
fn assign_head(rig: &SourceRig, roles: &mut Roles, legs: &LimbPair, arms: &LimbPair) {
    let taken: Vec<usize> =
        arms.limbs.iter().chain(&legs.limbs).flat_map(|limb| rig.ancestors(limb.joints[0])).collect();
    let up = rig.mean_vector(|frame| middle(rig, frame, arms, 0) - middle(rig, frame, legs, 0)).normalize_or_zero();
    let rise = |joint: usize| {
        rig.mean(|frame| (rig.clip.position(frame, joint) - rig.clip.position(frame, arms.fork)).dot(up))
    };
    let is_named = |chain: &Vec<usize>| {
        chain.iter().any(|&joint| rig.hints_at(joint, BodyPart::Neck) || rig.hints_at(joint, BodyPart::Head))
    };
    let chains =
        rig.children[arms.fork].iter().filter(|child| !taken.contains(child)).map(|&child| head_chain(rig, child));
    let height = |chain: &Vec<usize>| chain.last().map_or(f64::MIN, |&joint| rise(joint));
    let Some(chain) = chains.max_by(|a, b| is_named(a).cmp(&is_named(b)).then(height(a).total_cmp(&height(b)))) else {
        return;
    };
    let turning: Vec<usize> = chain.iter().copied().filter(|&joint| !rig.clip.joints[joint].is_end).collect();
    let named_head = turning.iter().copied().find(|&joint| rig.hints_at(joint, BodyPart::Head));
    let Some(head) = named_head.or(turning.get(1).copied()).or(turning.first().copied()) else { return };
    roles.joints[Joint::Head.index()] = Some(head);
    roles.joints[Joint::Neck.index()] = turning.first().copied().filter(|&neck| neck != head);
}

/// The joints from `child` to the head where a name states it, else to the farthest leaf.
fn head_chain(rig: &SourceRig, child: usize) -> Vec<usize> {
    match rig.subtree(child).into_iter().find(|&joint| rig.hints_at(joint, BodyPart::Head)) {
        Some(head) => {
            let mut chain: Vec<usize> = rig.ancestors(head);
            chain.truncate(1 + chain.iter().position(|&joint| joint == child).unwrap_or(0));
            chain.reverse();
            chain
        }
        None => rig.longest_chain(child),
    }
}

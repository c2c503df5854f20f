//! The role of each node: by VRM's bone table, else by the role finder on the bind pose as a clip of one frame.
//!
//! Without motion, names weigh more than shape: a named thigh beats a longer ear.

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::character::JOINTS_MAX;

use crate::character::bind_pose::BindPose;
use crate::character::extensions::{BoneTable, nodes_of_roles};
use crate::character::reason::{CharacterNote, CharacterReason};
use crate::error::RejectionReason;
use crate::read::source_clip::{SourceClip, SourceJoint};
use crate::rig::{self, joint_names, joint_names::BodyPart};

/// Least height of the hips above the ankles in the world at rest, divided by the leg length: ears stand up.
const HIPS_OVER_ANKLES_MIN: f64 = -0.3;

/// How the roles were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RolesFrom {
    /// VRM's bone table.
    Vrm,
    /// Names and shape of the bind pose.
    BindPose,
}

/// Slot of each role's node.
pub(crate) type SlotMap = [Option<usize>; JOINT_COUNT];

/// The nodes of all roles.
pub(crate) fn slots_of_roles(
    pose: &BindPose,
    table: Option<&BoneTable>,
    is_mesh: &[bool],
    notes: &mut Vec<CharacterNote>,
) -> Result<(SlotMap, RolesFrom), CharacterReason> {
    let mut slots = [None; JOINT_COUNT];
    let kept = joints(pose, is_mesh);
    if kept.len() > JOINTS_MAX {
        return Err(RejectionReason::TooManyJoints { count: kept.len() }.into());
    }
    if let Some(table) = table {
        for (role, node) in nodes_of_roles(table, pose.slot_of.len())? {
            slots[role.index()] = Some(pose.slot_of[node]);
        }
        let known = slots.map(|slot| kept.binary_search(&slot?).ok());
        if rig::check_known(&clip(pose, &kept), &known).map_err(of_character)? {
            notes.push(CharacterNote::MirroredNames);
            slots = Joint::ALL.map(|role| slots[role.mirrored().index()]);
        }
        check_directions(pose, &slots)?;
        return Ok((slots, RolesFrom::Vrm));
    }
    let clip = clip(pose, &kept);
    let roles = rig::find_roles_by_name(&clip, &[None; JOINT_COUNT]).map_err(of_character)?;
    if roles.are_names_mirrored {
        notes.push(CharacterNote::MirroredNames);
    }
    for (slot, joint) in slots.iter_mut().zip(roles.joints) {
        *slot = joint.map(|joint| kept[joint]);
    }
    check_legs(pose, &slots)?;
    if let Some([first, second]) = rig::surplus_legs(&at_rest(pose, clip, &kept), &roles, DVec3::Y) {
        return Err(CharacterReason::ManyLegs { first, second });
    }
    name_the_pelvis(pose, &mut slots);
    Ok((slots, RolesFrom::BindPose))
}

/// The nodes that may be joints: those of the scene, without meshes that nothing hangs from.
pub(crate) fn joints(pose: &BindPose, is_mesh: &[bool]) -> Vec<usize> {
    let mut has_children = vec![false; pose.parents.len()];
    pose.parents.iter().flatten().for_each(|&parent| has_children[parent] = true);
    let is_joint =
        |&slot: &usize| pose.is_skin_joint[slot] || (pose.is_in_scene[slot] && (!is_mesh[slot] || has_children[slot]));
    (0..pose.parents.len()).filter(is_joint).collect()
}

/// The bind pose of some nodes as a clip of one frame.
pub(crate) fn clip(pose: &BindPose, kept: &[usize]) -> SourceClip {
    let joint = |&slot: &usize| SourceJoint {
        name: pose.names[slot].clone(),
        parent: pose.parents[slot].and_then(|parent| kept.binary_search(&parent).ok()),
        is_end: false,
    };
    SourceClip {
        file: String::new(),
        clip: String::new(),
        joints: kept.iter().map(joint).collect(),
        first_frame: 0,
        frame_rate_hz: 1.0,
        positions: kept.iter().map(|&slot| pose.position_m(slot)).collect(),
        oriented: kept.len(),
        orientations: kept.iter().map(|&slot| pose.orientation(slot)).collect(),
        metres_per_unit: Some(1.0),
        up_axis: None,
        diagnostics: Vec::new(),
    }
}

/// A clip of the bind pose with the nodes where they are in the scene.
fn at_rest(pose: &BindPose, clip: SourceClip, kept: &[usize]) -> SourceClip {
    let positions = kept.iter().map(|&slot| pose.world[slot].w_axis.truncate()).collect();
    SourceClip { positions, ..clip }
}

/// A rejection of a clip in the words of characters.
fn of_character(reason: RejectionReason) -> CharacterReason {
    match reason {
        RejectionReason::NoLegs => CharacterReason::NoLegs,
        RejectionReason::NoArms { likeliest_legs } => {
            let spans = likeliest_legs.map(|[first, last]| format!("`{first}` to `{last}`"));
            CharacterReason::NoArms { legs: spans.join(" and ") }
        }
        RejectionReason::NotUpright { trunk_deg } => CharacterReason::FourLegs { trunk_deg },
        RejectionReason::ManifestContradicted { problem, .. } => CharacterReason::BrokenLimb { problem },
        other => CharacterReason::File(other),
    }
}

/// Checks that the legs are no ears: by their names, and by their direction in the world at rest.
fn check_legs(pose: &BindPose, slots: &SlotMap) -> Result<(), CharacterReason> {
    let is_helper = |joint: Joint| {
        let name = &pose.names[slots[joint.index()].unwrap_or(0)];
        joint_names::hints(name).parts.contains(&BodyPart::Helper)
    };
    if Joint::THIGHS.into_iter().chain(Joint::SHANKS).any(is_helper) {
        return Err(not_legs(pose, slots, "are named as ears, tails or helpers are"));
    }
    check_directions(pose, slots)
}

/// Checks that the legs do not stand upwards in the world at rest.
fn check_directions(pose: &BindPose, slots: &SlotMap) -> Result<(), CharacterReason> {
    let world_m = |joint: Joint| pose.world[slots[joint.index()].unwrap_or(0)].w_axis.truncate();
    for side in 0..2 {
        let leg_m: DVec3 = world_m(Joint::THIGHS[side]) - world_m(Joint::FEET[side]);
        if leg_m.y < HIPS_OVER_ANKLES_MIN * leg_m.length() {
            return Err(not_legs(pose, slots, "stand upwards"));
        }
    }
    Ok(())
}

fn not_legs(pose: &BindPose, slots: &SlotMap, problem: &'static str) -> CharacterReason {
    let thighs = Joint::THIGHS.map(|thigh| slots[thigh.index()].unwrap_or(0));
    let [first, second] = thighs.map(|slot| format!("`{}`", pose.names[slot]));
    CharacterReason::NotLegs { first, second, problem }
}

/// Thighs may hang from a root beside the hips. The joint on the spine that is named hips or pelvis is the pelvis then.
fn name_the_pelvis(pose: &BindPose, slots: &mut SlotMap) {
    let is_pelvis = |slot: usize| {
        let name = pose.names[slot].to_lowercase();
        name.contains("hips") || name.contains("pelvis")
    };
    let (Some(fork), Some(upper)) = (slots[Joint::Pelvis.index()], slots[Joint::SpineUpper.index()]) else { return };
    if is_pelvis(fork) {
        return;
    }
    let mut spine: Vec<usize> = pose.with_ancestors(upper).take_while(|&slot| slot != fork).collect();
    spine.reverse();
    let Some(position) = spine.iter().position(|&slot| is_pelvis(slot)) else { return };
    slots[Joint::Pelvis.index()] = Some(spine[position]);
    let (lower, middle) = match &spine[position + 1..] {
        [] | [_] => (None, None),
        [lower, between @ .., _] => (Some(*lower), between.get(between.len() / 2).copied()),
    };
    slots[Joint::SpineLower.index()] = lower;
    slots[Joint::SpineMiddle.index()] = middle;
    if spine.len() == position + 1 {
        slots[Joint::SpineUpper.index()] = None;
    }
}

/// The role that each node moves with: its own, or that of the nearest node above; none where there is none.
pub(crate) fn leaders(pose: &BindPose, slots: &SlotMap) -> Vec<Option<Joint>> {
    let mut leaders: Vec<Option<Joint>> = vec![None; pose.parents.len()];
    for role in Joint::ALL {
        if let Some(slot) = slots[role.index()] {
            leaders[slot] = Some(role);
        }
    }
    for slot in 0..leaders.len() {
        leaders[slot] = leaders[slot].or_else(|| leaders[pose.parents[slot]?]);
    }
    leaders
}

/// Roles of trunk and head that no node has.
pub(crate) fn missing(slots: &SlotMap) -> Vec<Joint> {
    const REPORTED: [Joint; 3] = [Joint::SpineUpper, Joint::Neck, Joint::Head];
    REPORTED.into_iter().filter(|role| slots[role.index()].is_none()).collect()
}

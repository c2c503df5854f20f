//! The nodes of the extra joints (fingers, toes, twist bones) and their axes in the bind pose.
//!
//! Nodes are found as in clips ([`crate::extra_joints`]), by their names below hands, feet and limbs; VRM's bone table comes
//! first for a hand of which it has a finger. Axes are those that clips are calibrated to, of the bind pose as a clip
//! of one frame, so a finger of the character points where the finger of a clip does. Body axes (x forward, y left, z up).

use glam::{DMat4, DQuat, DVec3};
use motiondb::body::extra_joint::FINGER_JOINTS;
use motiondb::body::{ExtraJoint, JOINT_COUNT, Joint, Side};

use crate::character::bind_pose::BindPose;
use crate::character::extensions::BoneTable;
use crate::character::joint_roles::{SlotMap, clip};
use crate::extra_joints::extra_search::extra_joints;
use crate::extra_joints::extra_tracks::ExtraTracks;
use crate::extra_joints::palm::turn_to_palms;
use crate::read::source_clip::SourceClip;
use crate::retarget::anchors::JointAnchor;
use crate::retarget::joint_tracks::{CalibratedTracks, JointTracks};
use crate::rig::roles::{ARMS, JointMap, LEGS, Roles, SourceExtra};

/// VRM's names of the joints of each finger, after the side, from the palm outwards: a thumb has no `Metacarpal` in VRM 0, and
/// no `Intermediate` in VRM 1.
const VRM_FINGERS: [&[&str]; 5] = [
    &["ThumbMetacarpal", "ThumbProximal", "ThumbIntermediate", "ThumbDistal"],
    &["IndexProximal", "IndexIntermediate", "IndexDistal"],
    &["MiddleProximal", "MiddleIntermediate", "MiddleDistal"],
    &["RingProximal", "RingIntermediate", "RingDistal"],
    &["LittleProximal", "LittleIntermediate", "LittleDistal"],
];

/// An extra joint of a bind pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExtraBone {
    /// What the joint is.
    pub extra: ExtraJoint,
    /// Slot of its node.
    pub slot: usize,
    /// Orientation of the parent's axes.
    pub parent_axes: DQuat,
    /// Orientation of the joint's axes.
    pub axes: DQuat,
}

/// The extra joints of a bind pose, in order. `kept` are the nodes that may be joints.
pub(crate) fn extra_bones(
    pose: &BindPose,
    slots: &SlotMap,
    kept: &[usize],
    table: Option<&BoneTable>,
    to_body: &DMat4,
) -> Vec<ExtraBone> {
    let clip = in_body_axes(clip(pose, kept), to_body);
    let place = |slot: usize| kept.binary_search(&slot).ok();
    let joints: JointMap = slots.map(|slot| place(slot?));
    let mut roles = Roles {
        joints,
        ends: [None; JOINT_COUNT],
        soles: [None; 2],
        heels: [None; 2],
        extra: Vec::new(),
        are_names_mirrored: false,
    };
    roles.extra = extra_joints(&clip, &roles).kept;
    if let Some(table) = table {
        let node = |name: &str| table.get(name).and_then(|&node| place(*pose.slot_of.get(node)?));
        Side::BOTH.into_iter().for_each(|side| take_fingers(&clip, &mut roles, side, node));
    }
    roles.extra.retain(|extra| joints[extra.joint.role().index()].is_some());
    calibrated(&clip, &roles, kept)
}

/// Replaces the fingers of a hand by those of VRM's bone table, where it has any.
fn take_fingers(clip: &SourceClip, roles: &mut Roles, side: Side, node: impl Fn(&str) -> Option<usize>) {
    let role = ARMS[side.index()][2];
    let Some(hand) = roles.joints[role.index()] else { return };
    let chain = |finger: usize| {
        // Names may call left what stands on the right: the fingers are those below the hand.
        let of_word = |word: &'static str| VRM_FINGERS[finger].iter().map(move |part| format!("{word}{part}"));
        let nodes = of_word("left").chain(of_word("right")).filter_map(|name| node(&name));
        chain_below(clip, hand, nodes.filter(|node| !roles.joints.contains(&Some(*node))))
    };
    let of_finger =
        |finger: usize| finger_joints(clip, &chain(finger), |joint| ExtraJoint::finger(side, finger, joint));
    let found: Vec<SourceExtra> = (0..VRM_FINGERS.len()).flat_map(of_finger).collect();
    if !found.is_empty() {
        roles.extra.retain(|extra| extra.joint.role() != role);
        roles.extra.extend(found);
        roles.extra.sort();
    }
}

/// Those of some joints that hang from one another, the first from `top`.
fn chain_below(clip: &SourceClip, top: usize, joints: impl Iterator<Item = usize>) -> Vec<usize> {
    let is_below = |joint: usize, above: usize| {
        std::iter::successors(clip.joints[joint].parent, |&at| clip.joints[at].parent).any(|at| at == above)
    };
    let mut chain = Vec::new();
    for joint in joints {
        if is_below(joint, chain.last().copied().unwrap_or(top)) {
            chain.push(joint);
        }
    }
    chain
}

/// The extra joints of the chain of a finger's joints, each with the far end of its bone.
fn finger_joints(clip: &SourceClip, chain: &[usize], joint: impl Fn(usize) -> ExtraJoint) -> Vec<SourceExtra> {
    let child = |source: usize| clip.joints.iter().position(|child| child.parent == Some(source));
    let extra = |number: usize| {
        let source = chain[number];
        SourceExtra { joint: joint(number), source, end: chain.get(number + 1).copied().or_else(|| child(source)) }
    };
    (0..chain.len().min(FINGER_JOINTS)).map(extra).collect()
}

/// A clip turned into body axes.
fn in_body_axes(mut clip: SourceClip, to_body: &DMat4) -> SourceClip {
    let turn = to_body.to_scale_rotation_translation().1;
    clip.positions.iter_mut().for_each(|position_m| *position_m = to_body.transform_point3(*position_m));
    clip.orientations.iter_mut().for_each(|orientation| *orientation = (turn * *orientation).normalize());
    clip
}

/// The extra joints with their axes.
fn calibrated(clip: &SourceClip, roles: &Roles, kept: &[usize]) -> Vec<ExtraBone> {
    let at_role = |joint: Joint| JointAnchor { joint: roles.joints[joint.index()].unwrap_or(0), offset_m: DVec3::ZERO };
    let anchors = Joint::ALL.map(at_role);
    // R = G·K, with R the axes in the bind pose.
    let mut constants = Joint::ALL.map(|joint| {
        let source = clip.orientation(0, anchors[joint.index()].joint);
        (source.inverse() * limb_axes(clip, roles, joint)).normalize()
    });
    let tracks = JointTracks { clip, roles, anchors: &anchors, forward: &[DVec3::X], upright: &[0] };
    turn_to_palms(&tracks, &mut constants);
    let calibrated = CalibratedTracks { tracks, constants: &constants };
    let bone = |(extra, [parent_axes, axes]): (&SourceExtra, [DQuat; 2])| ExtraBone {
        extra: extra.joint,
        slot: kept[extra.source],
        parent_axes,
        axes,
    };
    roles.extra.iter().zip(ExtraTracks::of(&calibrated).axes(&calibrated, 0)).map(bone).collect()
}

/// The axes of a role in the bind pose: those of the rest, turned by the shortest arc to the bone of a limb. Hands whose
/// palms are not known go on along their forearms.
fn limb_axes(clip: &SourceClip, roles: &Roles, joint: Joint) -> DQuat {
    let bone = |rest: DVec3, [from, to]: [Joint; 2]| {
        let position_m = |joint: Joint| Some(clip.position(0, roles.joints[joint.index()]?));
        let along = (position_m(to)? - position_m(from)?).try_normalize()?;
        Some(DQuat::from_rotation_arc(rest, along))
    };
    let axes = Side::BOTH.into_iter().find_map(|side| {
        let [upper_arm, forearm, hand] = ARMS[side.index()];
        let [thigh, shank, foot] = LEGS[side.index()];
        let out = f64::from(side.sign()) * DVec3::Y;
        match joint {
            _ if joint == upper_arm => bone(out, [upper_arm, forearm]),
            _ if joint == forearm || joint == hand => bone(out, [forearm, hand]),
            _ if joint == thigh => bone(DVec3::NEG_Z, [thigh, shank]),
            _ if joint == shank => bone(DVec3::NEG_Z, [shank, foot]),
            _ => None,
        }
    });
    axes.unwrap_or(DQuat::IDENTITY)
}

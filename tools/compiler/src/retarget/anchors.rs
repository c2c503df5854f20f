//! Where every canonical joint sits on the source skeleton: on the joint of its role or, where the source has none
//! (toes, clavicles, spine, neck), at a fixed point of the joint that would carry it.

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};

use crate::read::source_clip::SourceClip;
use crate::retarget::units::middle;
use crate::rig::roles::Roles;

/// A point fixed to a source joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    pub joint: usize,
    /// In the source joint's own frame, metres.
    pub offset_m: DVec3,
}

/// Shares along a line at which missing joints are put: plain anatomy, spine joints evenly, the clavicle's root near
/// the breastbone.
const CHEST_SHARE: f64 = 0.65;
const NECK_SHARE: f64 = 0.35;
const CLAVICLE_SHARE: f64 = 0.15;
/// Head joint above the neck joint and ball before the ankle, over leg length.
const NECK_OVER_LEG: f64 = 0.12;
const FOOT_OVER_LEG: f64 = 0.16;
/// Ball below the ankle, over leg length.
const ANKLE_OVER_LEG: f64 = 0.07;

impl Anchor {
    pub(crate) fn position_m(&self, clip: &SourceClip, frame: usize) -> DVec3 {
        clip.position(frame, self.joint) + clip.orientation(frame, self.joint) * self.offset_m
    }
}

/// The anchors of all joints; `forward` is the body's facing on the ground in each frame.
pub(crate) fn anchors(clip: &SourceClip, roles: &Roles, forward: &[DVec3], leg_m: f64) -> [Anchor; JOINT_COUNT] {
    let at_role = |joint: Joint| Anchor { joint: roles.joints[joint.index()].unwrap_or(0), offset_m: DVec3::ZERO };
    let mut anchors = Joint::ALL.map(at_role);
    put_trunk(clip, roles, &mut anchors);
    put_head(clip, roles, leg_m, &mut anchors);
    put_clavicles(clip, roles, &mut anchors);
    put_toes(clip, roles, forward, leg_m, &mut anchors);
    anchors
}

fn missing(roles: &Roles, joint: Joint) -> bool {
    roles.joints[joint.index()].is_none()
}

/// The pelvis between the hips; missing spine joints on the line from there to the chest.
fn put_trunk(clip: &SourceClip, roles: &Roles, anchors: &mut [Anchor; JOINT_COUNT]) {
    let pelvis = roles.required(Joint::Pelvis);
    let hips = |frame| middle(clip, roles, Joint::THIGHS, frame);
    anchors[Joint::Pelvis.index()] = fixed(clip, pelvis, hips);
    if missing(roles, Joint::SpineUpper) {
        let shoulders = |frame| middle(clip, roles, Joint::UPPER_ARMS, frame);
        anchors[Joint::SpineUpper.index()] =
            fixed(clip, pelvis, |frame| hips(frame).lerp(shoulders(frame), CHEST_SHARE));
    }
    let chest = anchors[Joint::SpineUpper.index()];
    if missing(roles, Joint::SpineLower) {
        let third = |frame| hips(frame).lerp(chest.position_m(clip, frame), 1.0 / 3.0);
        anchors[Joint::SpineLower.index()] = fixed(clip, pelvis, third);
    }
    let lower = anchors[Joint::SpineLower.index()];
    if missing(roles, Joint::SpineMiddle) {
        let half = |frame| lower.position_m(clip, frame).lerp(chest.position_m(clip, frame), 0.5);
        anchors[Joint::SpineMiddle.index()] = fixed(clip, lower.joint, half);
    }
}

/// A missing neck between shoulders and head, a missing head above the neck.
fn put_head(clip: &SourceClip, roles: &Roles, leg_m: f64, anchors: &mut [Anchor; JOINT_COUNT]) {
    if missing(roles, Joint::Neck) {
        let neck = |frame| {
            let shoulders = middle(clip, roles, Joint::UPPER_ARMS, frame);
            let head = roles.joints[Joint::Head.index()];
            head.map_or(shoulders, |head| shoulders.lerp(clip.position(frame, head), NECK_SHARE))
        };
        anchors[Joint::Neck.index()] = fixed(clip, anchors[Joint::SpineUpper.index()].joint, neck);
    }
    let neck = anchors[Joint::Neck.index()];
    if missing(roles, Joint::Head) {
        let above = |frame| neck.position_m(clip, frame) + NECK_OVER_LEG * leg_m * DVec3::Z;
        anchors[Joint::Head.index()] = fixed(clip, neck.joint, above);
    }
}

fn put_clavicles(clip: &SourceClip, roles: &Roles, anchors: &mut [Anchor; JOINT_COUNT]) {
    let chest = anchors[Joint::SpineUpper.index()].joint;
    for (clavicle, arm) in [(Joint::LeftClavicle, Joint::LeftUpperArm), (Joint::RightClavicle, Joint::RightUpperArm)] {
        if missing(roles, clavicle) {
            let arm = roles.required(arm);
            let shoulders = |frame| middle(clip, roles, Joint::UPPER_ARMS, frame);
            let root = |frame| shoulders(frame).lerp(clip.position(frame, arm), CLAVICLE_SHARE);
            anchors[clavicle.index()] = fixed(clip, chest, root);
        }
    }
}

fn put_toes(clip: &SourceClip, roles: &Roles, forward: &[DVec3], leg_m: f64, anchors: &mut [Anchor; JOINT_COUNT]) {
    for side in 0..2 {
        if missing(roles, Joint::TOES[side]) {
            let ankle = roles.required(Joint::FEET[side]);
            let foot = |frame: usize| FOOT_OVER_LEG * forward[frame] - ANKLE_OVER_LEG * DVec3::Z;
            let ball = |frame: usize| clip.position(frame, ankle) + leg_m * foot(frame);
            anchors[Joint::TOES[side].index()] = fixed(clip, ankle, ball);
        }
    }
}

/// The point of a joint's frame that is on average where `target` is.
fn fixed(clip: &SourceClip, joint: usize, target: impl Fn(usize) -> DVec3) -> Anchor {
    let local = |frame| clip.orientation(frame, joint).inverse() * (target(frame) - clip.position(frame, joint));
    let sum: DVec3 = (0..clip.frame_count()).map(local).sum();
    Anchor { joint, offset_m: sum / clip.frame_count() as f64 }
}

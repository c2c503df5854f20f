//! Anchors of the canonical joints on the source skeleton: the joint of the role, or, where the source has none (toes,
//! clavicles, spine, neck), a fixed point of the joint that carries it. Clips are in metres, z up.

use glam::DVec3;
use motiondb::body::{JOINT_COUNT, Joint};

use crate::read::source_clip::SourceClip;
use crate::retarget::units::middle;
use crate::rig::roles::Roles;

/// A point that is fixed to a source joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointAnchor {
    /// The source joint.
    pub joint: usize,
    /// Offset in the joint's own frame, m.
    pub offset_m: DVec3,
}

/// Height of the upper spine joint between hips (0) and shoulders (1), by plain anatomy.
const CHEST_SHARE: f64 = 0.65;
/// Position of the neck joint between the shoulders' middle (0) and the head (1).
const NECK_SHARE: f64 = 0.35;
/// Position of a clavicle's root between the shoulders' middle (0) and the shoulder (1): near the breastbone.
const CLAVICLE_SHARE: f64 = 0.15;
/// Height of the head joint above the neck joint, divided by leg length.
const NECK_OVER_LEG: f64 = 0.12;
/// Distance of the ball in front of the ankle, over leg length.
const FOOT_OVER_LEG: f64 = 0.16;
/// Height of the ankle above the ball, divided by leg length.
const ANKLE_OVER_LEG: f64 = 0.07;

impl JointAnchor {
    /// Global position in one frame, m.
    pub(crate) fn position_m(&self, clip: &SourceClip, frame: usize) -> DVec3 {
        let position_m = clip.position(frame, self.joint);
        if self.offset_m == DVec3::ZERO {
            return position_m;
        }
        position_m + clip.orientation(frame, self.joint) * self.offset_m
    }
}

/// Anchors of all joints. `forward` is the body's facing on the ground in each frame.
pub(crate) fn anchors(clip: &SourceClip, roles: &Roles, forward: &[DVec3], leg_m: f64) -> [JointAnchor; JOINT_COUNT] {
    let at_role = |joint: Joint| JointAnchor { joint: roles.joints[joint.index()].unwrap_or(0), offset_m: DVec3::ZERO };
    let mut anchors = Joint::ALL.map(at_role);
    put_trunk(clip, roles, &mut anchors);
    put_head(clip, roles, leg_m, &mut anchors);
    put_clavicles(clip, roles, &mut anchors);
    put_toes(clip, roles, forward, leg_m, &mut anchors);
    anchors
}

fn is_missing(roles: &Roles, joint: Joint) -> bool {
    roles.joints[joint.index()].is_none()
}

/// The pelvis between the hips. Missing spine joints lie on the lines hips → shoulders and hips → chest.
fn put_trunk(clip: &SourceClip, roles: &Roles, anchors: &mut [JointAnchor; JOINT_COUNT]) {
    let pelvis = roles.required(Joint::Pelvis);
    let hips = |frame| middle(clip, roles, Joint::THIGHS, frame);
    anchors[Joint::Pelvis.index()] = fixed(clip, pelvis, hips);
    if is_missing(roles, Joint::SpineUpper) {
        let shoulders = |frame| middle(clip, roles, Joint::UPPER_ARMS, frame);
        anchors[Joint::SpineUpper.index()] =
            fixed(clip, pelvis, |frame| hips(frame).lerp(shoulders(frame), CHEST_SHARE));
    }
    let chest = anchors[Joint::SpineUpper.index()];
    if is_missing(roles, Joint::SpineLower) {
        let third = |frame| hips(frame).lerp(chest.position_m(clip, frame), 1.0 / 3.0);
        anchors[Joint::SpineLower.index()] = fixed(clip, pelvis, third);
    }
    let lower = anchors[Joint::SpineLower.index()];
    if is_missing(roles, Joint::SpineMiddle) {
        let half = |frame| lower.position_m(clip, frame).lerp(chest.position_m(clip, frame), 0.5);
        anchors[Joint::SpineMiddle.index()] = fixed(clip, lower.joint, half);
    }
}

/// A missing neck lies between shoulders and head, a missing head above the neck.
fn put_head(clip: &SourceClip, roles: &Roles, leg_m: f64, anchors: &mut [JointAnchor; JOINT_COUNT]) {
    if is_missing(roles, Joint::Neck) {
        let neck = |frame| {
            let shoulders = middle(clip, roles, Joint::UPPER_ARMS, frame);
            let head = roles.joints[Joint::Head.index()];
            head.map_or(shoulders, |head| shoulders.lerp(clip.position(frame, head), NECK_SHARE))
        };
        anchors[Joint::Neck.index()] = fixed(clip, anchors[Joint::SpineUpper.index()].joint, neck);
    }
    let neck = anchors[Joint::Neck.index()];
    if is_missing(roles, Joint::Head) {
        let above = |frame| neck.position_m(clip, frame) + NECK_OVER_LEG * leg_m * DVec3::Z;
        anchors[Joint::Head.index()] = fixed(clip, neck.joint, above);
    }
}

/// Missing clavicles begin between the shoulders.
fn put_clavicles(clip: &SourceClip, roles: &Roles, anchors: &mut [JointAnchor; JOINT_COUNT]) {
    let chest = anchors[Joint::SpineUpper.index()].joint;
    for (clavicle, arm) in [(Joint::LeftClavicle, Joint::LeftUpperArm), (Joint::RightClavicle, Joint::RightUpperArm)] {
        if is_missing(roles, clavicle) {
            let arm = roles.required(arm);
            let shoulders = |frame| middle(clip, roles, Joint::UPPER_ARMS, frame);
            let root = |frame| shoulders(frame).lerp(clip.position(frame, arm), CLAVICLE_SHARE);
            anchors[clavicle.index()] = fixed(clip, chest, root);
        }
    }
}

/// Missing toes lie in front of the ankles and below them.
fn put_toes(clip: &SourceClip, roles: &Roles, forward: &[DVec3], leg_m: f64, anchors: &mut [JointAnchor; JOINT_COUNT]) {
    for side in 0..2 {
        if is_missing(roles, Joint::TOES[side]) {
            let ankle = roles.required(Joint::FEET[side]);
            let foot = |frame: usize| FOOT_OVER_LEG * forward[frame] - ANKLE_OVER_LEG * DVec3::Z;
            let ball = |frame: usize| clip.position(frame, ankle) + leg_m * foot(frame);
            anchors[Joint::TOES[side].index()] = fixed(clip, ankle, ball);
        }
    }
}

/// The point of a joint's frame whose position is that of `target` on average.
fn fixed(clip: &SourceClip, joint: usize, target: impl Fn(usize) -> DVec3) -> JointAnchor {
    let local = |frame| clip.orientation(frame, joint).inverse() * (target(frame) - clip.position(frame, joint));
    let sum: DVec3 = (0..clip.frame_count()).map(local).sum();
    JointAnchor { joint, offset_m: sum / clip.frame_count() as f64 }
}

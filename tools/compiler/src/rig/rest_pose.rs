//! What a rest pose shows of a rig: its up axis, and the head's offset, since a figure at rest looks straight ahead.
//!
//! Only a body that stands straight on straight legs shows the head. Zero poses of many files are none: LaFAN1's bones all
//! lie along one axis. Source axes.

use std::iter::successors;

use glam::{DMat3, DQuat, DVec3};
use motiondb::body::Joint;

use crate::read::axis::Axis;
use crate::read::source_clip::SourceJoint;
use crate::read::source_motion::JointPoses;
use crate::rig::roles::Roles;

/// Least cosine between the vertical and trunk, legs and their bones (20°): in A-poses legs are spread.
const STRAIGHT_COSINE: f64 = 0.94;
/// Least cosine between the vertical and the line from the head to its farthest joint, or from the shoulders to a head
/// without joints (45°). A head whose end lies aside shows no direction: one such rig (CMU's for Poser) is 28° off.
const HEAD_COSINE: f64 = 0.7;

/// What a rest pose shows.
pub(crate) struct RestPose {
    /// Axis nearest to the direction from ankles to hips; any axis where both coincide.
    pub(crate) up: Axis,
    /// Whether it is a body that stands on straight legs.
    pub(crate) stands: bool,
    /// Rotation of an upright head in the frame of the source's head joint; none where the rest pose is no body that
    /// stands.
    pub(crate) head_offset: Option<DQuat>,
}

impl RestPose {
    /// What the rest pose of a rig shows.
    pub(crate) fn of(joints: &[SourceJoint], rest: &JointPoses, roles: &Roles) -> Self {
        let stands = stands(rest, roles);
        let head_offset = if stands { head_offset(joints, rest, roles) } else { None };
        Self { up: up_axis(rest, roles), stands, head_offset }
    }
}

fn up_axis(rest: &JointPoses, roles: &Roles) -> Axis {
    let middle = |pair: [Joint; 2]| pair.map(|joint| rest.positions[roles.required(joint)]).into_iter().sum::<DVec3>();
    Axis::nearest(middle(Joint::THIGHS) - middle(Joint::FEET))
}

/// Whether trunk and legs are straight, one over the other.
fn stands(rest: &JointPoses, roles: &Roles) -> bool {
    let position = |joint: Joint| rest.positions[roles.required(joint)];
    let middle = |pair: [Joint; 2]| 0.5 * (position(pair[0]) + position(pair[1]));
    let [hips, ankles, shoulders] = [Joint::THIGHS, Joint::FEET, Joint::UPPER_ARMS].map(middle);
    let up = Axis::nearest(shoulders - ankles).direction();
    let is_upright = |from: DVec3, to: DVec3| (to - from).normalize_or_zero().dot(up) > STRAIGHT_COSINE;
    let is_leg_straight = |side: usize| {
        let [hip, knee, ankle] = [Joint::THIGHS, Joint::SHANKS, Joint::FEET].map(|pair| position(pair[side]));
        is_upright(knee, hip) && is_upright(ankle, knee)
    };
    is_upright(hips, shoulders) && is_leg_straight(0) && is_leg_straight(1)
}

/// The head's offset in a rest pose that stands.
fn head_offset(joints: &[SourceJoint], rest: &JointPoses, roles: &Roles) -> Option<DQuat> {
    let position = |joint: Joint| roles.joints[joint.index()].map(|joint| rest.positions[joint]);
    let middle = |pair: [Joint; 2]| Some(0.5 * (position(pair[0])? + position(pair[1])?));
    let [ankles, shoulders] = [middle(Joint::FEET)?, middle(Joint::UPPER_ARMS)?];
    let up = Axis::nearest(shoulders - ankles).direction();
    let across = position(Joint::LeftThigh)? - position(Joint::RightThigh)?;
    let left = across.reject_from_normalized(up).try_normalize()?;
    let forward = left.cross(up);
    let feet =
        Joint::TOES.into_iter().zip(Joint::FEET).filter_map(|(toe, foot)| Some(position(toe)? - position(foot)?));
    let faces_forward = feet.map(|foot| foot.dot(forward)).all(|along| along > 0.0);
    let head = roles.joints[Joint::Head.index()]?;
    let is_head_up =
        head_bone(joints, rest, head).unwrap_or(rest.positions[head] - shoulders).normalize_or_zero().dot(up);
    let upright_head = DQuat::from_mat3(&DMat3::from_cols(forward, left, up));
    let shows_head = faces_forward && is_head_up > HEAD_COSINE;
    shows_head.then(|| rest.orientations[head].inverse() * upright_head)
}

/// The line from the head to its farthest joint.
fn head_bone(joints: &[SourceJoint], rest: &JointPoses, head: usize) -> Option<DVec3> {
    let hangs_from_head =
        |&joint: &usize| successors(joints[joint].parent, |&above| joints[above].parent).any(|above| above == head);
    let lines = (0..joints.len()).filter(hangs_from_head).map(|joint| rest.positions[joint] - rest.positions[head]);
    lines.max_by(|a, b| a.length().total_cmp(&b.length()))
}

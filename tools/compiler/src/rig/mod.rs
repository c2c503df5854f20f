//! Rig: the role of each source joint in a human body. Shape and motion decide first, names second.
//!
//! Enters: a [`SourceClip`], in source units and axes. Leaves: its [`Roles`], or why the skeleton is not human.
//!
//! Read `roles`, then `source_rig` (the skeleton in the form that role search uses), `joint_names` (hints), `limb` and
//! `body_plan`, then `role_search` and `role_assignment` (one search), and last `two_bodies` (files with two
//! characters), `surplus_legs` (bodies with more than two legs), `rig_head` (what the clips of one rig share)
//! and `rest_pose`. `body_angles` measures trunk and arms by their roles, `carriage` compares them.

pub(crate) mod body_angles;
mod body_plan;
pub(crate) mod carriage;
pub(crate) mod joint_names;
mod limb;
pub(crate) mod rest_pose;
pub(crate) mod rig_head;
mod role_assignment;
mod role_search;
pub(crate) mod roles;
mod source_rig;
mod surplus_legs;
mod two_bodies;

use glam::DVec3;

use crate::error::RejectionReason;
use crate::read::source_clip::{MAX_JOINTS, SourceClip};

pub use roles::{JointMap, Roles, SourceExtra};
use source_rig::SourceRig;
pub(crate) use source_rig::sampled_frames;

/// The roles of a clip's joints. `known` states some of them: all joints of legs and arms, or none of them.
///
/// # Errors
/// Why the skeleton is not human, or why `known` cannot be true.
pub fn find_roles(clip: &SourceClip, known: &JointMap) -> Result<Roles, RejectionReason> {
    check_size(clip)?;
    if known.iter().all(Option::is_none) {
        two_bodies::check_is_one_body(clip)?;
    }
    let found = role_search::search(clip, known);
    // Repeated names were copied from one side to the other. The shape alone may be clearer.
    if found.is_err() && has_repeated_names(clip) {
        return role_search::search(&without_names(clip), known).or(found);
    }
    found
}

/// The roles of a bind or rest pose, a clip of one frame, in which names weigh more than shape.
///
/// # Errors
/// As [`find_roles`].
pub(crate) fn find_roles_by_name(clip: &SourceClip, known: &JointMap) -> Result<Roles, RejectionReason> {
    check_size(clip)?;
    if known.iter().all(Option::is_none) {
        two_bodies::check_is_one_body(clip)?;
    }
    role_search::search_by_name(clip, known)
}

/// Names of the uppermost joints of a pair of legs that a body has beside those of its roles; none of a human body.
/// `vertical` is upwards in the clip.
pub(crate) fn surplus_legs(clip: &SourceClip, roles: &Roles, vertical: DVec3) -> Option<[String; 2]> {
    surplus_legs::surplus_legs(&SourceRig::new(clip), roles, vertical)
}

/// Checks the roles that a file states itself. Returns whether left and right are swapped.
///
/// # Errors
/// Why the roles cannot be true.
pub(crate) fn check_known(clip: &SourceClip, known: &JointMap) -> Result<bool, RejectionReason> {
    check_size(clip)?;
    role_search::check_known(clip, known)
}

/// Checks that a skeleton is no larger than the search for roles, which compares many pairs of joints, can handle.
///
/// # Errors
/// [`RejectionReason::TooManyJoints`].
pub(crate) fn check_size(clip: &SourceClip) -> Result<(), RejectionReason> {
    match clip.joints.len() {
        count if count > MAX_JOINTS => Err(RejectionReason::TooManyJoints { count }),
        _ => Ok(()),
    }
}

fn has_repeated_names(clip: &SourceClip) -> bool {
    let mut names: Vec<&str> = clip.joints.iter().filter(|joint| !joint.is_end).map(|joint| &*joint.name).collect();
    names.retain(|name| !name.is_empty());
    names.sort_unstable();
    names.windows(2).any(|pair| pair[0] == pair[1])
}

fn without_names(clip: &SourceClip) -> SourceClip {
    let mut clip = clip.clone();
    clip.joints.iter_mut().for_each(|joint| joint.name.clear());
    clip
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use motiondb::body::JOINT_COUNT;

    use super::*;
    use crate::read::source_clip::SourceJoint;

    /// A skeleton of so many joints in two frames.
    fn skeleton(count: usize, parent: impl Fn(usize) -> usize) -> SourceClip {
        let joint = |joint: usize| SourceJoint {
            name: format!("joint {joint}"),
            parent: (joint > 0).then(|| parent(joint)),
            is_end: false,
        };
        SourceClip {
            file: "heap.glb".into(),
            clip: String::new(),
            joints: (0..count).map(joint).collect(),
            first_frame: 0,
            frame_rate_hz: 30.0,
            positions: (0..2 * count).map(|index| DVec3::new(index as f64, 0.0, 0.0)).collect(),
            oriented: count,
            orientations: vec![DQuat::IDENTITY; 2 * count],
            metres_per_unit: None,
            up_axis: None,
            diagnostics: Vec::new(),
        }
    }

    /// Without the limit each of these takes minutes.
    #[test]
    fn skeletons_of_200000_joints_are_refused_at_once() {
        let too_many = Err(RejectionReason::TooManyJoints { count: 200_000 });
        let shapes: [fn(usize) -> usize; 3] = [|joint| joint - 1, |_| 0, |joint| (joint - 1) / 2];
        for parent in shapes {
            assert_eq!(find_roles(&skeleton(200_000, parent), &[None; JOINT_COUNT]), too_many);
        }
    }
}

//! Rig: the role of each source joint in a human body. Shape and motion decide first, names second.
//!
//! Enters: a [`SourceClip`], in source units and axes. Leaves: its [`Roles`], or why the skeleton is not human.
//!
//! Read `roles`, then `source_rig` (the skeleton in the form that role search uses), `joint_names` (hints), `limb` and
//! `body_plan`, then `role_search` and `role_assignment` (one search), and last `two_bodies` (files with two
//! characters).

mod body_plan;
mod joint_names;
mod limb;
mod role_assignment;
mod role_search;
pub(crate) mod roles;
mod source_rig;
mod two_bodies;

use crate::error::RejectionReason;
use crate::read::source_clip::SourceClip;

pub use roles::{JointMap, Roles};

/// The roles of a clip's joints. `known` states some of them: all joints of legs and arms, or none of them.
///
/// # Errors
/// Why the skeleton is not human, or why `known` cannot be true.
pub fn find_roles(clip: &SourceClip, known: &JointMap) -> Result<Roles, RejectionReason> {
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

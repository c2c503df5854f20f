//! Rig: which source joint plays which role of a human body. Shape and motion decide first, names second.
//!
//! Enters: a `SourceClip`. Leaves: a joint for each role, or why the skeleton is no human's.
//!
//! Read `source_rig` (the skeleton as role finding sees it), then `body_plan` and `limb`, then `roles`; `joint_names` gives
//! hints, `facing` finds left and right, `two_bodies` rejects pairs.

pub(crate) mod body_plan;
pub(crate) mod facing;
pub(crate) mod joint_names;
pub(crate) mod limb;
pub(crate) mod roles;
pub(crate) mod source_rig;
pub(crate) mod two_bodies;

pub use roles::{Roles, find_roles};

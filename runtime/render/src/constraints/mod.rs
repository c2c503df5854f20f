//! Pictures of one agent's velocity space: why a velocity was planned (`FbCrowd` Figs. 3–5).
//!
//! Enters: one step, planned again from the recording. Leaves: a panel beside the scene.
//!
//! Read `overlay_constraints`, then `velocity_panel`, `feasible_region`, `legend`, `scene_marks`.

pub(crate) mod feasible_region;
pub(crate) mod legend;
pub(crate) mod overlay_constraints;
pub(crate) mod scene_marks;
pub(crate) mod velocity_panel;

pub use overlay_constraints::ConstraintOverlay;

//! The constraint overlay: pictures of one agent's velocity space, which show why a velocity was planned (`FbCrowd`
//! Figs. 3–5).
//!
//! Enters: a drawn scene, and the recording, from which one step is planned again. Leaves: the scene with marks, and a
//! panel per agent beside it.
//!
//! Read `constraint_overlay`, then `explained_step`. A panel is `velocity_panel`, with `feasible_region` and `legend`;
//! the marks in the scene are `scene_marks`. Both use the colours and names of `constraint_style`.

pub(crate) mod constraint_overlay;
pub(crate) mod constraint_style;
pub(crate) mod explained_step;
pub(crate) mod feasible_region;
pub(crate) mod legend;
pub(crate) mod scene_marks;
pub(crate) mod velocity_panel;

pub use constraint_overlay::ConstraintOverlay;

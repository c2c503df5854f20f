//! Cycles: the strides of a window become one closed cycle, phase 0 at right mid-stance.
//!
//! Enters: [`HumanClip`](crate::retarget::HumanClip)s and the target body. Leaves: for each clip its steady cycles,
//! with their flaws and diagnostics, or why it has none. A [`GaitCycle`] is in the root frame (x forward, y left, z up,
//! metres).
//!
//! Read `analyzed_clip` (the chapter's steps), then `gait_cycle` with `mirrored`, `mean_stride` with `loop_closure`,
//! `standing_cycle`; then the verdict on a cycle: `steady_cycle` with `rate_snapping`, `foot_slide`,
//! `posture_warnings`, `flaws`, `rate_cells`; and `corners`, which no cycle shows.

pub(crate) mod analyzed_clip;
pub(crate) mod corners;
pub(crate) mod flaws;
pub(crate) mod foot_slide;
pub(crate) mod gait_cycle;
pub(crate) mod loop_closure;
pub(crate) mod mean_stride;
pub(crate) mod mirrored;
mod posture_warnings;
pub(crate) mod rate_cells;
pub(crate) mod rate_snapping;
pub(crate) mod rest;
pub(crate) mod standing_cycle;
pub(crate) mod steady_cycle;

pub use gait_cycle::GaitCycle;
pub use mean_stride::mean_stride;

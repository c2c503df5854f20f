//! Cycles: the strides of a window become one closed cycle, phase 0 at right mid-stance.
//!
//! Read `mean_stride` with `pose_mean`, then `loop_closure` and `foot_slide`, then `analysis`, one clip from window to cycle.

pub(crate) mod analysis;
pub(crate) mod foot_slide;
pub(crate) mod loop_closure;
pub(crate) mod mean_stride;
pub(crate) mod pose_mean;

pub use mean_stride::{GaitCycle, NamedCycle, mean_stride};

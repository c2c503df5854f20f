//! The plan of a gait: what a speed makes of it, from published curves and values.
//!
//! Enters: the motion of the root and the duration of a stride. Leaves: a [`GaitPlan`], and a [`StrideVariation`] that
//! changes it from stride to stride.
//!
//! Read `root_motion`, `published_curves`, then `gait_plan` (the quantities), `gaits` (their values by speed),
//! `slow_change` and `variation`.

pub(crate) mod gait_plan;
pub(crate) mod gaits;
pub(crate) mod published_curves;
pub(crate) mod root_motion;
pub(crate) mod slow_change;
pub(crate) mod variation;

pub(crate) use gait_plan::{FRAME_RATE_HZ, GaitPlan};
pub(crate) use root_motion::RootMotion;
pub(crate) use slow_change::SlowChange;
pub(crate) use variation::StrideVariation;

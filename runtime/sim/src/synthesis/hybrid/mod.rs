//! Hybrid synthesis: which of blending and semi-procedural locomotion moves a body, and the change between them
//! (`FbCrowd` §3.4.1, §5, App. 10).
//!
//! Read `mode`, `switch_points`, `switching`, then what keeps the pose continuous: `inertialization` and
//! `pose_smoothing`; `active_motion` samples whichever is in force.

pub(crate) mod active_motion;
pub(crate) mod inertialization;
pub(crate) mod mode;
pub(crate) mod pose_smoothing;
pub(crate) mod switch_points;
pub(crate) mod switching;

pub use active_motion::Playing;
pub use inertialization::{CARRIED_S, Inertia};
pub use mode::{Choice, Mode, Thresholds};
pub use pose_smoothing::Seen;
pub use switch_points::Hybrid;

//! Hybrid synthesis: which of blending and semi-procedural locomotion moves a body, and the change between them
//! (`FbCrowd` §3.4.1, §5, App. 10).
//!
//! Read `mode`, `switch_points`, `switching`, then what keeps the pose continuous: `inertialization` and
//! `pose_smoothing`; `active_motion` samples whichever is in force.

pub mod active_motion;
pub mod inertialization;
pub mod mode;
pub mod pose_smoothing;
pub mod switch_points;
pub(crate) mod switching;

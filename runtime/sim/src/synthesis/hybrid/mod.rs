//! Hybrid synthesis: which of blending and semi-procedural locomotion moves a body, and the switch between them
//! (`FbCrowd` §3.4.1, §5, App. 10).
//!
//! Enters: a plan and a command. Leaves: the active motion and its pose.
//!
//! Read `motion_state` (the state of the active motion), then `mode_selection` and `switching`, then what keeps the
//! pose continuous: `pose_smoothing` and `inertialization`; `active_motion` samples the pose in the active mode;
//! `idle_clock` gives the pose of a body that stands, `step_timing` the pace of its steps, `played_transition` the pose of
//! a body that starts as in a clip.

pub(crate) mod active_motion;
pub(crate) mod extra_state;
pub(crate) mod idle_clock;
pub(crate) mod inertialization;
pub(crate) mod mode_selection;
pub(crate) mod motion_state;
pub(crate) mod played_transition;
pub(crate) mod pose_smoothing;
pub(crate) mod step_timing;
pub(crate) mod switching;

pub(crate) use active_motion::ActiveMotion;
pub use extra_state::ExtraState;
pub(crate) use inertialization::Inertialization;
pub(crate) use motion_state::Moment;
pub use motion_state::MotionState;
pub use pose_smoothing::SmoothedMotion;

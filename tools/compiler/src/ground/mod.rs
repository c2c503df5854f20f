//! Grounding: every clip moves on one body, with a root free of stride ripple and feet on the ground.
//!
//! Enters: `HumanClip`s. Leaves: `GroundedClip`s on the target skeleton.
//!
//! Read `target_skeleton` with `anthropometry`, then `arc` and `root_motion`, `loop_unrolling`, and last `foot_grounding`
//! with `leg_ik`.

pub(crate) mod anthropometry;
pub(crate) mod arc;
pub(crate) mod foot_grounding;
pub(crate) mod leg_ik;
pub(crate) mod loop_unrolling;
pub(crate) mod root_motion;
pub(crate) mod target_skeleton;

pub use arc::{Arc, Rates, RootSample};
pub use root_motion::{GroundedClip, ground};

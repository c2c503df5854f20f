//! Grounding: transfers every clip to one common skeleton, removes the step oscillation from the root, and puts the
//! feet on the ground.
//!
//! Enters: [`HumanClip`](crate::retarget::HumanClip)s, each on its performer's own body. Leaves: [`GroundedClip`]s on
//! the target body, in the world frame (metres, seconds, radians, Z up).
//!
//! Read `target_body` and `head_bends` (what the clips of a set decide together), then `grounded_clip` with
//! `grounded_poses` and `loop_rounds`; then `root_motion` (the chapter's path from clip to grounded clip) with
//! `loop_unrolling` and `foot_grounding`, then what they use: `pose_mean`, `leg_ik`, `rotations`. `root_arc` is the path
//! of the root over one stride, which the next chapters fit.

pub(crate) mod foot_grounding;
pub(crate) mod grounded_clip;
pub(crate) mod grounded_poses;
pub(crate) mod head_bends;
pub(crate) mod leg_ik;
pub(crate) mod loop_rounds;
pub(crate) mod loop_unrolling;
pub(crate) mod pose_mean;
pub(crate) mod root_arc;
pub(crate) mod root_motion;
pub(crate) mod rotations;
pub(crate) mod target_body;

pub use grounded_clip::GroundedClip;
pub use root_arc::{Rates, RootArc, RootSample};
pub use root_motion::grounded_clip;

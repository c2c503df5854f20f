//! Motion blending: a weighted sum of examples that moves at requested parameters (`FbCrowd` §5, App. 10).
//!
//! Enters: (v_f, ω_t, ω_s). Leaves: shares of examples, phase rate and pose.
//!
//! Read `blend_domain` (which examples) with `cadence_curve` (at which rate), then `example_mix` and `pose_weights`
//! (how they move), then `pose_landmarks` (how far a change of weights moves the pose). `command::weight_transition`
//! changes the shares over time.

pub(crate) mod blend_domain;
pub(crate) mod cadence_curve;
pub(crate) mod example_mix;
pub(crate) mod pose_landmarks;
pub(crate) mod pose_weights;

pub use blend_domain::{BlendDomain, Reachable};
pub use example_mix::ExampleMix;
pub use pose_weights::PoseWeights;

//! Motion blending: a weighted sum of examples that moves as requested (`FbCrowd` §5, App. 10).
//!
//! Enters: (v_f, ω_t, ω_s). Leaves: shares of examples, phase rate and pose.
//!
//! Read `blend_space`, then `mix`, then `weight_transition`.

pub(crate) mod blend_space;
pub(crate) mod mix;
pub(crate) mod weight_transition;

pub use blend_space::{Nearest, Space};
pub use mix::{Mix, Weights};

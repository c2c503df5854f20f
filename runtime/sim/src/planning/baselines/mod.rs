//! The planners that the paper compares MCN with (`FbCrowd` §7, Table 1), as their authors published them.
//!
//! Both plan for discs only. Enters: the world view. Leaves: a plan. Its velocity comes from the baseline, its facing
//! follows the velocity. Time to collision and density (inputs of Eq. 1) are computed as in MCN.
//!
//! Read `orca`, `social_force`, then `facing`, which completes their plans.

pub(crate) mod facing;
pub(crate) mod orca;
pub(crate) mod social_force;

pub use orca::OrcaParams;
pub use social_force::{Force, RESPONSE_S, SocialForceParams};

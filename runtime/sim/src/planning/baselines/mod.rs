//! The planners that the paper compares MCN with (`FbCrowd` §7, Table 1), as their authors published them.
//!
//! Neither knows of bodies. Enters: the world view. Leaves: a plan whose velocity is the planner's and whose facing
//! follows it; time to collision and density, which Eq. 1 reads, are measured as MCN measures them.
//!
//! Read `orca`, `social_force`, then `facing`, which completes their plans.

pub(crate) mod facing;
pub(crate) mod orca;
pub(crate) mod social_force;

pub use orca::OrcaParams;
pub use social_force::{Force, SocialForceParams};

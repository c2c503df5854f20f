//! Coupling of navigation and synthesis (CNS, `FbCrowd` §3.4): after each step the disc takes the body's position.
//!
//! Enters: the bodies and plans of a step. Leaves: what planners read of the agents in the next step.
//!
//! Read `body_to_disc`; `decoupled` is the baseline of the paper's user study.

pub(crate) mod body_to_disc;
pub(crate) mod decoupled;
#[cfg(test)]
mod doors;

pub use body_to_disc::{as_planned, outside_walls};

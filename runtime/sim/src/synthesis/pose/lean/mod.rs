//! Lean: bodies tilt in the direction in which they accelerate. `FbCrowd` does not have it.
//!
//! Enters: the drawn motion, and how far the played clips lean by themselves. Leaves: the posture.
//!
//! Read `balance` (how far a body leans), `incline` (how a pose tilts), then `excess_lean` (what a body leans beyond its
//! clips).

pub(crate) mod balance;
pub(crate) mod excess_lean;
pub(crate) mod incline;
#[cfg(test)]
mod tests;

pub(crate) use excess_lean::ExcessLean;

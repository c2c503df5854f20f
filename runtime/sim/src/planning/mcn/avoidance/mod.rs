//! Avoidance: the half-planes that keep an agent off walls and other agents (`FbCrowd` §4.4).
//!
//! Enters: the world view, and the surroundings of one agent. Leaves: half-planes with weights, in its memory,
//! and whether its body waits.
//!
//! Read `agents_and_walls`, Eq. 12; then what the paper lacks: `slowing` (agents see each other brake), `pressing`
//! (agents in contact dissolve an arch), `queueing` (agents that wait hold their place) and `resting` (bodies at rest
//! stay).

mod agents_and_walls;
mod pressing;
mod queueing;
mod resting;
mod slowing;
#[cfg(test)]
mod tests;

pub(crate) use agents_and_walls::avoid;
pub(crate) use queueing::waits;
pub(crate) use resting::stays;

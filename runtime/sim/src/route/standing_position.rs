//! Where an agent stands before a closed door, at its goal, or behind others.

use std::num::NonZeroU32;

use glam::Vec2;

/// The position of an agent that stands, or that brakes in order to stand there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingPosition {
    /// The position, world, m.
    pub position_m: Vec2,
    /// Number of agents that stand one behind the other up to the front, this one included; none while the agent brakes.
    pub rank: Option<NonZeroU32>,
}

impl StandingPosition {
    /// Whether the agent stands.
    pub(crate) fn is_taken(self) -> bool {
        self.rank.is_some()
    }

    /// The position of an agent that is at `position_m` now: one that stands may have been pushed.
    pub(crate) fn now(self, position_m: Vec2) -> Self {
        if self.is_taken() { Self { position_m, ..self } } else { self }
    }
}

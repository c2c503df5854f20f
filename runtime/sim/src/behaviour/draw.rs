//! Random numbers of agents: each depends on seed, agent, number of states entered and purpose alone.

use crate::maths::random::SplitMix64;

/// Streams of the behaviour in a seed; the scenario's agents and their starting phases use those below.
const BEHAVIOUR_STREAMS: u64 = 1 << 40;

/// Streams of the events in a seed.
const EVENT_STREAMS: u64 = 1 << 41;

/// What a number is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The goal of a state.
    Goal,
    /// The position in the area of a goal.
    Position,
    /// The state to which a transition leads, by its index.
    Target(u32),
    /// The duration of a condition, by its index in the state.
    Duration(u32),
    /// The value of a setting, by its index in the state.
    Setting(u32),
}

/// The generator of the durations of an event, by index.
pub(crate) fn event_random(seed: u64, event: usize) -> SplitMix64 {
    SplitMix64::new(seed, EVENT_STREAMS + event as u64)
}

/// Who draws, and when.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawer {
    pub(crate) seed: u64,
    /// Stable id of the agent.
    pub(crate) agent: u32,
    /// Number of states that the agent has entered.
    pub(crate) entries: u32,
}

impl Drawer {
    /// The generator for a purpose.
    pub(crate) fn random(self, purpose: Purpose) -> SplitMix64 {
        let (kind, index) = match purpose {
            Purpose::Goal => (0, 0),
            Purpose::Position => (1, 0),
            Purpose::Target(index) => (2, index),
            Purpose::Duration(index) => (3, index),
            Purpose::Setting(index) => (4, index),
        };
        let of_agent = SplitMix64::new(self.seed, BEHAVIOUR_STREAMS + u64::from(self.agent)).next_u64();
        SplitMix64::new(of_agent ^ u64::from(self.entries), u64::from(index) << 3 | kind)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn agents_entries_and_purposes_draw_apart() {
        let mut drawn = BTreeSet::new();
        for agent in 0..20 {
            for entries in 0..20 {
                let drawer = Drawer { seed: 1, agent, entries };
                for purpose in [Purpose::Goal, Purpose::Position, Purpose::Target(0), Purpose::Target(1)] {
                    drawn.insert(drawer.random(purpose).next_u64());
                }
            }
        }
        assert_eq!(drawn.len(), 20 * 20 * 4);
    }
}

//! The state of a source during a simulation: its next due time, and its generator of positions.

use crate::maths::random::SplitMix64;
use crate::scenario::{DueTimes, Scenario, SourceSpec};

/// The state of one source.
#[derive(Clone, Debug)]
pub(crate) struct SourceState {
    due_times: DueTimes,
    /// Time at which the next agent is due, s; none after the last one.
    next_s: Option<f64>,
    /// Generator of positions in the source's area.
    pub(crate) positions: SplitMix64,
}

impl SourceState {
    /// The states of all sources at the start.
    pub(crate) fn all(scenario: &Scenario) -> Vec<Self> {
        let start = |(index, source): (usize, &SourceSpec)| {
            let mut due_times = source.due_times(scenario.seed, index);
            let next_s = due_times.next();
            Self { due_times, next_s, positions: SourceSpec::positions(scenario.seed, index) }
        };
        scenario.sources.iter().enumerate().map(start).collect()
    }

    /// Number of agents that became due until now.
    pub(crate) fn due_until(&mut self, now_s: f64) -> u32 {
        let mut due = 0;
        while self.next_s.is_some_and(|next_s| next_s <= now_s) {
            self.next_s = self.due_times.next();
            due += 1;
        }
        due
    }
}

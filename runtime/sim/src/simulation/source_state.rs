//! The state of a source during a simulation: its next due time, and its generator of positions.

use crate::maths::random::SplitMix64;
use crate::population::AgentId;
use crate::scenario::{DueTimes, GroupMember, GroupSizes, Scenario, SourceSpec};

/// The state of one source.
#[derive(Clone, Debug)]
pub(crate) struct SourceState {
    due_times: DueTimes,
    /// Time at which the next agent is due, s; none after the last one.
    next_s: Option<f64>,
    /// Generator of positions in the source's area.
    pub(crate) positions: SplitMix64,
    groups: Option<GroupSizes>,
    /// Generator of the sizes of groups that become due.
    due_sizes: SplitMix64,
    /// Agents that are due before the rest of their group.
    gathered: u32,
    /// Size of the group that gathers.
    gathering_size: u32,
    /// Generator of the sizes of groups that appear: the same sizes.
    born_sizes: SplitMix64,
    /// The group that appears now, and the number of its members still to come.
    appearing: Option<(GroupMember, u32)>,
}

impl SourceState {
    /// The states of all sources at the start.
    pub(crate) fn all(scenario: &Scenario) -> Vec<Self> {
        let start = |(index, source): (usize, &SourceSpec)| {
            let mut due_times = source.due_times(scenario.seed, index);
            let next_s = due_times.next();
            let sizes = SourceSpec::group_sizes(scenario.seed, index);
            let mut state = Self {
                due_times,
                next_s,
                positions: SourceSpec::positions(scenario.seed, index),
                groups: source.groups,
                due_sizes: sizes,
                gathered: 0,
                gathering_size: 1,
                born_sizes: sizes,
                appearing: None,
            };
            state.gathering_size = state.next_due_size();
            state
        };
        scenario.sources.iter().enumerate().map(start).collect()
    }

    /// Number of agents that became due until now. A group is due with its last member; the last group may be smaller.
    pub(crate) fn due_until(&mut self, now_s: f64) -> u32 {
        let mut due = 0;
        while self.next_s.is_some_and(|next_s| next_s <= now_s) {
            self.next_s = self.due_times.next();
            self.gathered += 1;
            if self.gathered == self.gathering_size || self.next_s.is_none() {
                due += std::mem::take(&mut self.gathered);
                self.gathering_size = self.next_due_size();
            }
        }
        due
    }

    fn next_due_size(&mut self) -> u32 {
        self.groups.map_or(1, |groups| groups.draw(&mut self.due_sizes) as u32)
    }

    /// The group of the agent that appears next, with this id; none of an agent that walks alone.
    pub(crate) fn group_of_next(&self, id: AgentId) -> Option<GroupMember> {
        let groups = self.groups?;
        if let Some((group, _)) = self.appearing {
            return Some(group);
        }
        let mut sizes = self.born_sizes;
        let size = groups.draw(&mut sizes);
        (size > 1).then_some(GroupMember { first: id.0, spacing_m: groups.spacing_m })
    }

    /// Notes that an agent of a group, or alone, has appeared.
    pub(crate) fn has_appeared(&mut self, group: Option<GroupMember>) {
        let Some(groups) = self.groups else { return };
        let left = match self.appearing {
            Some((_, left)) => left - 1,
            None => groups.draw(&mut self.born_sizes) as u32 - 1,
        };
        self.appearing = group.filter(|_| left > 0).map(|group| (group, left));
    }
}

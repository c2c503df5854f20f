//! Number of agents that go to, or stand in, each area of the goals.

use crate::behaviour::agent_state::{AgentState, GoalRef};
use crate::behaviour::goals::GoalSet;

/// Number of agents in each area of each set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Occupancy(Vec<Vec<u32>>);

impl Occupancy {
    /// No agent anywhere.
    pub(crate) fn new(goals: &[GoalSet]) -> Self {
        Self(goals.iter().map(|set| vec![0; set.areas.len()]).collect())
    }

    /// Number of agents in each area of a set.
    pub fn of_set(&self, set: usize) -> &[u32] {
        &self.0[set]
    }

    pub(crate) fn take(&mut self, goal: GoalRef) {
        self.0[goal.set as usize][goal.area as usize] += 1;
    }

    pub(crate) fn release(&mut self, goal: GoalRef) {
        let taken = &mut self.0[goal.set as usize][goal.area as usize];
        *taken = taken.saturating_sub(1);
    }

    /// Indices of the areas of a set that have room, ascending.
    pub(crate) fn free(&self, set: usize, goals: &GoalSet) -> Vec<usize> {
        let taken = self.of_set(set);
        (0..taken.len()).filter(|&area| taken[area] < goals.capacity(area)).collect()
    }

    /// The place at the end of a queue: behind the last one taken. None where the queue is full.
    pub(crate) fn end_of_queue(&self, set: usize) -> Option<usize> {
        let taken = self.of_set(set);
        let behind_last = taken.iter().rposition(|&taken| taken > 0).map_or(0, |last| last + 1);
        (behind_last < taken.len()).then_some(behind_last)
    }

    /// Gives up an agent's goal; a goal that the agent remembers stays taken.
    pub(crate) fn leave(&mut self, agent: &mut AgentState) {
        let Some(goal) = agent.goal.take() else { return };
        let is_remembered = agent.remembered.iter().any(|(_, remembered)| remembered.at == goal.at);
        if goal.is_taken && !is_remembered {
            self.release(goal.at);
        }
    }
}

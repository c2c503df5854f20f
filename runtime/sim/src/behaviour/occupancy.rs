//! The positions that agents hold in each area of the goals: those that go there, or stand there. World, metres.

use glam::Vec2;

use crate::behaviour::agent_state::{AgentState, ChosenGoal, GoalRef};
use crate::behaviour::goals::GoalSet;

/// The agents in each area of each set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Occupancy {
    counts: Vec<Vec<u32>>,
    positions_m: Vec<Vec<Vec<Vec2>>>,
}

impl Occupancy {
    /// No agent anywhere.
    pub(crate) fn new(goals: &[GoalSet]) -> Self {
        Self {
            counts: goals.iter().map(|set| vec![0; set.areas.len()]).collect(),
            positions_m: goals.iter().map(|set| vec![Vec::new(); set.areas.len()]).collect(),
        }
    }

    /// Number of agents in each area of a set.
    pub fn of_set(&self, set: usize) -> &[u32] {
        &self.counts[set]
    }

    /// The positions that agents hold in an area, m, in no particular order.
    pub(crate) fn positions_m(&self, at: GoalRef) -> &[Vec2] {
        &self.positions_m[at.set as usize][at.area as usize]
    }

    pub(crate) fn take(&mut self, goal: &ChosenGoal) {
        let (set, area) = (goal.at.set as usize, goal.at.area as usize);
        self.counts[set][area] += 1;
        self.positions_m[set][area].push(goal.position_m);
    }

    pub(crate) fn release(&mut self, goal: &ChosenGoal) {
        let (set, area) = (goal.at.set as usize, goal.at.area as usize);
        let held_m = &mut self.positions_m[set][area];
        if let Some(index) = held_m.iter().position(|&held_m| held_m == goal.position_m) {
            held_m.swap_remove(index);
            self.counts[set][area] -= 1;
        }
    }

    /// Indices of the areas of a set that have room for a number of agents, ascending.
    pub(crate) fn free(&self, set: usize, goals: &GoalSet, agents: u32) -> Vec<usize> {
        let at = |area: usize| GoalRef { set: set as u32, area: area as u32 };
        (0..goals.areas.len()).filter(|&area| self.has_room(goals, at(area), agents)).collect()
    }

    /// Whether an area of a set has room for a number of agents.
    pub(crate) fn has_room(&self, goals: &GoalSet, at: GoalRef, agents: u32) -> bool {
        self.of_set(at.set as usize)[at.area as usize].saturating_add(agents) <= goals.capacity(at.area as usize)
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
            self.release(&goal);
        }
    }
}

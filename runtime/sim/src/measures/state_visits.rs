//! Visits of the states of a scenario: agents that were in each, agents that are in it at the end, and the time there.
//! Seconds.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::behaviour::Behaviour;
use crate::population::AgentId;
use crate::recording::frame::AgentFrame;
use crate::scenario::Scenario;

/// The visits of one state, under the keys of `fbcrowd measure --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StateMeasures {
    /// Name of the state.
    pub state: String,
    /// Number of agents that were in the state in any frame.
    pub visited: usize,
    /// Number of agents that are in the state in the last frame.
    pub at_end: usize,
    /// Mean time that an agent which was in the state spent there in all, s; none where no agent was.
    pub mean_time_s: Option<f64>,
}

/// Follows the states of all agents, frame by frame.
#[derive(Debug)]
pub(crate) struct StateVisits {
    names: Vec<String>,
    dt_s: f64,
    /// For each state, the agents that were in it.
    visitors: Vec<BTreeSet<AgentId>>,
    /// For each state, the number of agents in it, summed over frames.
    agent_frames: Vec<u64>,
}

impl StateVisits {
    /// Begins with the frame at the start.
    pub(crate) fn new(scenario: &Scenario, start: &[AgentFrame]) -> Self {
        let Behaviour { states, .. } = &scenario.behaviour;
        let mut visits = Self {
            names: states.iter().map(|state| state.name.clone()).collect(),
            dt_s: scenario.dt_s.into(),
            visitors: vec![BTreeSet::new(); states.len()],
            agent_frames: vec![0; states.len()],
        };
        visits.push(start);
        visits
    }

    /// Adds a frame; a scenario without states has none to count.
    pub(crate) fn push(&mut self, agents: &[AgentFrame]) {
        for agent in agents {
            let state = usize::from(agent.state);
            if let (Some(visitors), Some(frames)) = (self.visitors.get_mut(state), self.agent_frames.get_mut(state)) {
                visitors.insert(agent.id);
                *frames += 1;
            }
        }
    }

    /// The visits, given the last frame.
    pub(crate) fn finish(self, last: &[AgentFrame]) -> Vec<StateMeasures> {
        let Self { names, dt_s, visitors, agent_frames } = self;
        let measures =
            |(index, ((state, visitors), frames)): (usize, ((String, BTreeSet<AgentId>), u64))| StateMeasures {
                state,
                visited: visitors.len(),
                at_end: last.iter().filter(|agent| usize::from(agent.state) == index).count(),
                mean_time_s: (!visitors.is_empty()).then(|| frames as f64 * dt_s / visitors.len() as f64),
            };
        names.into_iter().zip(visitors).zip(agent_frames).enumerate().map(measures).collect()
    }
}

//! Arrival of an agent: its root comes near its last goal after it has passed all other waypoints. World, metres.

use glam::{DVec2, Vec2};

use crate::route::path::PathProgress;
use crate::scenario::AgentSpec;

/// Distance from the last goal within which an agent has arrived, m: what `fbcrowd measure` counts.
pub(crate) const ARRIVAL_M: f64 = 0.5;

/// Whether and when one agent has arrived.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Arrival {
    /// Waypoints passed so far: on a round trip the start is near the last goal.
    pub(crate) progress: PathProgress,
    /// Whether the agent is near its last goal now.
    pub(crate) is_at_goal: bool,
    /// Time at which it first was, s; none before.
    pub(crate) at_s: Option<f64>,
}

impl Arrival {
    /// Follows the agent's root to its present position. Returns whether the agent arrives now for the first time. An
    /// agent that begins in a state of the behaviour arrives when it enters a final state, or is removed.
    pub(crate) fn follow(&mut self, agent: &AgentSpec, position_m: Vec2, is_in_final_state: bool, now_s: f64) -> bool {
        self.is_at_goal = match agent.state {
            0 => is_at_goal(agent, position_m, &mut self.progress),
            _ => is_in_final_state,
        };
        let arrives = self.is_at_goal && self.at_s.is_none();
        if arrives {
            self.at_s = Some(now_s);
        }
        arrives
    }
}

/// Whether an agent has passed its waypoints and is near its last goal.
pub(crate) fn is_at_goal(agent: &AgentSpec, position_m: Vec2, progress: &mut PathProgress) -> bool {
    let to_last = progress.pass(agent, position_m);
    let goal_m = agent.goals_m.last().copied().unwrap_or(agent.position_m);
    to_last && DVec2::from(position_m).distance(goal_m.into()) < ARRIVAL_M
}

//! Whether and when an agent has arrived: its root, the waypoints passed, comes near to its last goal. World, metres.

use glam::{DVec2, Vec2};

use crate::route::path::Progress;
use crate::scenario::AgentSpec;

/// How near, m.
pub(crate) const ARRIVAL_M: f64 = 0.5;

/// One agent on its way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arrival {
    /// Which waypoints it has passed: on a round trip it is near the last one before.
    pub progress: Progress,
    /// It is near the last goal now.
    pub is_at_goal: bool,
    /// When it first was; none before.
    pub at_s: Option<f64>,
}

impl Arrival {
    /// Follows the root of `agent` to where it is now; whether it arrives with that.
    pub fn follow(&mut self, agent: &AgentSpec, position_m: Vec2, now_s: f64) -> bool {
        let to_last = self.progress.pass(agent, position_m);
        let goal_m = agent.goals_m.last().copied().unwrap_or(agent.position_m);
        self.is_at_goal = to_last && DVec2::from(position_m).distance(goal_m.into()) < ARRIVAL_M;
        let arrives = self.is_at_goal && self.at_s.is_none();
        if arrives {
            self.at_s = Some(now_s);
        }
        arrives
    }
}

//! What the state machine reads in a step: of the crowd, and of itself as the last step left it. World, metres, seconds.

use glam::Vec2;

use crate::behaviour::agent_state::GoalRef;
use crate::behaviour::area::Area;
use crate::maths::random::SplitMix64;
use crate::population::AgentId;

/// Positions in an area that are drawn before one that a wall covers is taken.
const CLEAR_DRAWS_MAX: usize = 64;

/// Length of the route of an agent in a state, both by index, from a position to an area, m; none where there is no route.
pub type RouteLength<'a> = dyn Fn((usize, u32), Vec2, GoalRef) -> Option<f32> + Sync + 'a;

/// What the state machine reads of the crowd.
pub struct CrowdView<'a> {
    /// Time, s.
    pub time_s: f64,
    /// Seed of the scenario.
    pub seed: u64,
    /// Stable ids of the agents, ascending.
    pub ids: &'a [AgentId],
    /// Present positions, m.
    pub positions_m: &'a [Vec2],
    /// For each agent the index of the first present member of its group, its own of an agent without a group; empty
    /// where no agent has a group.
    pub leads: &'a [usize],
    /// Lengths of routes through the doors that are open.
    pub route_m: &'a RouteLength<'a>,
    /// The same as with all doors open; none where no door is closed.
    pub open_route_m: Option<&'a RouteLength<'a>>,
    /// Distance of an agent, by index, to the end of its own waypoints, m; none before it has passed all others.
    pub path_end_m: &'a (dyn Fn(usize) -> Option<f32> + Sync),
    /// Whether an agent, by index, has come to the goal that it had in the last step: its body stands there, or comes to rest
    /// there, or was pushed no farther than a step away.
    pub has_come_to_goal: &'a (dyn Fn(usize) -> bool + Sync),
    /// Whether an agent, by index, has begun; before, it enters no state.
    pub has_begun: &'a (dyn Fn(usize) -> bool + Sync),
    /// Whether no wall of an agent in a state, both by index, covers a position.
    pub is_clear: &'a (dyn Fn((usize, u32), Vec2) -> bool + Sync),
}

impl CrowdView<'_> {
    /// A position drawn from an area for an agent in a state, on free ground where a few draws find some, m.
    pub(crate) fn draw_clear_m(&self, of: (usize, u32), area: &Area, random: &mut SplitMix64) -> Vec2 {
        let mut position_m = area.draw_m(random);
        for _ in 1..CLEAR_DRAWS_MAX {
            if (self.is_clear)(of, position_m) {
                break;
            }
            position_m = area.draw_m(random);
        }
        position_m
    }
}

/// What holds for all agents in a step.
pub(crate) struct Moment {
    /// Whether each signal is green.
    pub(crate) green: Vec<bool>,
    /// Number of agents in each area.
    pub(crate) numbers: Vec<u32>,
    /// Number of agents in each state.
    pub(crate) populations: Vec<u32>,
    /// For each set that is a queue, the agent that may join it in this step.
    pub(crate) joining: Vec<Option<usize>>,
}

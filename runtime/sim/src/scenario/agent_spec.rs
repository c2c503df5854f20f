//! One agent of a scenario at its start.

use glam::Vec2;
use serde::{Deserialize, Serialize};

/// One agent at its start: position, goals, disc and preferred speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentSpec {
    /// Start of the agent, world, m.
    pub position_m: Vec2,
    /// Facing at the start, world, rad; towards the first goal unless the scenario sets it.
    pub facing_rad: f32,
    /// Waypoints in order, world, m; the last one is the goal.
    pub goals_m: Vec<Vec2>,
    /// Radius of the bounding disc, m.
    pub radius_m: f32,
    /// Speed of v_pref, m/s.
    pub preferred_speed_mps: f32,
}

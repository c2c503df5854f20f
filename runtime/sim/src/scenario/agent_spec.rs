//! One agent of a scenario at its start.

use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Default radius of the disc that walls hold, m: people pass a door of 0.5 m in single file, within 0.23 m of its
/// middle (Wuppertal 2018), which a disc of 0.25 m could not.
pub const WALL_RADIUS_M: f32 = 0.2;

/// One agent at its start: position, goals, disc and preferred speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentSpec {
    /// Start of the agent, world, m.
    pub position_m: Vec2,
    /// Facing at the start, world, rad; towards the first goal unless the scenario sets it.
    pub facing_rad: f32,
    /// Waypoints in order, world, m; the last one is the goal.
    pub goals_m: Vec<Vec2>,
    /// Radius of the bounding disc, which other agents see, m.
    pub radius_m: f32,
    /// Radius of the disc that walls hold, m; at most `radius_m`. A door narrower than twice this is closed.
    pub wall_radius_m: f32,
    /// Speed of v_pref, m/s.
    pub preferred_speed_mps: f32,
}

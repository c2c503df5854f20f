//! What a planner may know: every agent and wall as the last step left them.
//!
//! Frozen while all are planned, so agents may be planned in any order and on any thread. World axes, metres, seconds,
//! radians; slices are by agent.

use glam::Vec2;

use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::orca::agents::Disc;
use crate::planning::plan::Stance;
use crate::world::neighbours::Neighbours;
use crate::world::obstacles::Obstacles;

/// Everything that a plan depends on.
#[derive(Clone, Copy, Debug)]
pub struct World<'a> {
    /// Of the synthesised roots, m.
    pub positions_m: &'a [Vec2],
    /// Of the synthesised roots, m/s.
    pub velocities_mps: &'a [Vec2],
    /// Of the synthesised roots, rad.
    pub facings_rad: &'a [f32],
    /// Of the bounding discs, m.
    pub radii_m: &'a [f32],
    /// v_pref, m/s.
    pub preferred_mps: &'a [Vec2],
    /// How each body stands.
    pub stances: &'a [Stance],
    /// [`Plan::strafing_s`](crate::planning::plan::Plan::strafing_s) of the last step.
    pub strafing_s: &'a [f32],
    /// [`Plan::stepping_back_s`](crate::planning::plan::Plan::stepping_back_s) of the last step.
    pub stepping_back_s: &'a [f32],
    /// Built from the same positions, velocities and radii, for [`crate::planning::planner::ahead_s`] of who plans.
    pub neighbours: &'a Neighbours,
    /// The walls.
    pub obstacles: &'a Obstacles,
    /// Of the database's velocity sets.
    pub constraints: &'a MotionConstraints,
    /// Step, s.
    pub dt_s: f32,
    /// Whether bodies follow: they take a plan up later than at the end of the step.
    pub bodies: bool,
}

impl World<'_> {
    /// An agent's bounding disc.
    pub fn disc(&self, agent: usize) -> Disc {
        Disc {
            position_m: self.positions_m[agent],
            velocity_mps: self.velocities_mps[agent],
            radius_m: self.radii_m[agent],
        }
    }

    /// How far ahead of the present velocities forces lead, s, where bodies take a plan up within `taken_up` seconds.
    /// Discs have theirs at the end of the step. Bodies lag: of what forces add within a fine step they would take up
    /// next to nothing, and one that stands would never start to step.
    pub fn lead_s(&self, taken_up_s: f32) -> f32 {
        if self.bodies { taken_up_s.max(self.dt_s) } else { self.dt_s }
    }

    /// Unit vector along an agent's facing.
    pub fn forward(&self, agent: usize) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.facings_rad[agent]);
        Vec2::new(cos, sin)
    }

    /// The ends of a wall's edge, relative to an agent's centre.
    pub fn edge_m(&self, agent: usize, edge: u32) -> [Vec2; 2] {
        self.obstacles.ends_m(edge).map(|end_m| end_m - self.positions_m[agent])
    }
}

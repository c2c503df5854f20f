//! Why a velocity was planned: all that a planner weighed for one agent in one step, for pictures and tests.
//!
//! The planner itself is run, on the same [`World`], and what it leaves in its working memory is handed out. World
//! axes, m/s and m/s².

use glam::Vec2;

use crate::params::Params;
use crate::planning::baselines::social_force::{self, Force};
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::plan::Plan;
use crate::planning::planner::{self, Planner, Scratch};
use crate::planning::world_view::World;
use crate::world::neighbours::Neighbour;

/// Violations up to this are rounding, m/s.
const ROUNDING_MPS: f32 = 1e-3;

/// One agent's plan and what led to it.
#[derive(Clone, Debug)]
pub struct Reasons {
    /// What was planned.
    pub plan: Plan,
    /// v_op; v_pref itself where the planner does not adapt it.
    pub adapted_mps: Vec2,
    /// By rank: walls, stance, sharp turns, hull, agents. None for social forces.
    pub half_planes: Vec<HalfPlane>,
    /// Who was taken into account, best rank first. Social forces feel everybody within range.
    pub neighbours: Vec<Neighbour>,
    /// What pushes, where social forces plan: by agent, then by wall.
    pub forces: Vec<Force>,
}

impl Reasons {
    /// Plans once more.
    pub fn new(planner: Planner, world: &World, agent: usize, params: &Params) -> Self {
        let mut scratch = Scratch::default();
        let plan = planner::plan(planner, world, agent, params, &mut scratch);
        let forces = match planner {
            Planner::SocialForce => social_force::forces(world, agent, &params.social_force, &scratch),
            Planner::Mcn | Planner::Orca => Vec::new(),
        };
        Self {
            plan,
            adapted_mps: scratch.adapted_mps,
            neighbours: scratch.nearest.as_slice().to_vec(),
            half_planes: scratch.half_planes().to_vec(),
            forces,
        }
    }

    /// Whether a half-plane had to yield.
    pub fn has_yielded(&self, half_plane: &HalfPlane) -> bool {
        half_plane.violation_mps(self.plan.velocity_mps) > ROUNDING_MPS
    }

    /// Whether the velocity lies on a half-plane's line: without it, another would have been planned.
    pub fn binds(&self, half_plane: &HalfPlane) -> bool {
        half_plane.violation_mps(self.plan.velocity_mps).abs() <= ROUNDING_MPS
    }
}

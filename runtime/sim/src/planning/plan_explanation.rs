//! Why a velocity was planned: everything that a planner weighed for one agent in one step, for pictures and tests.
//!
//! Runs the planner itself on the same [`WorldView`] and copies its working memory. World axes, m/s and m/s².

use glam::Vec2;

use crate::params::Params;
use crate::planning::baselines::social_force::{self, Force};
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::plan::Plan;
use crate::planning::planner::{self, Planner, PlannerMemory};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;

/// Violation of a half-plane that counts as rounding, m/s.
const ROUNDING_MPS: f32 = 1e-3;

/// One agent's plan and what led to it.
#[derive(Clone, Debug)]
pub struct PlanExplanation {
    /// The plan.
    pub plan: Plan,
    /// v_op, m/s; v_pref itself where the planner does not adapt it.
    pub adapted_mps: Vec2,
    /// The half-planes by rank: walls, stance, sharp turn, hull, agents. None of social forces.
    pub half_planes: Vec<HalfPlane>,
    /// The neighbours taken into account, best rank first. Social forces act between all agents within range.
    pub neighbours: Vec<Neighbour>,
    /// Forces of social forces on the agent: from agents, then from walls.
    pub forces: Vec<Force>,
}

impl PlanExplanation {
    /// Plans once more and keeps what led to the plan.
    pub fn new(planner: Planner, world: &WorldView, agent: usize, params: &Params) -> Self {
        let mut memory = PlannerMemory::default();
        let plan = planner::plan(planner, world, agent, params, &mut memory);
        let preferred_mps = world.preferred_mps[agent];
        let (adapted_mps, surroundings) = match planner {
            Planner::Mcn => (memory.mcn.adapted_mps, &memory.mcn.surroundings),
            Planner::Orca => (preferred_mps, &memory.orca.surroundings),
            Planner::SocialForce => (preferred_mps, &memory.social_force),
        };
        let forces = match planner {
            Planner::SocialForce => social_force::forces(world, agent, &params.social_force, surroundings),
            Planner::Mcn | Planner::Orca => Vec::new(),
        };
        let neighbours = surroundings.neighbours.as_slice().to_vec();
        Self { plan, adapted_mps, half_planes: memory.half_planes(planner).to_vec(), neighbours, forces }
    }

    /// Whether the planned velocity violates a half-plane: it had to yield.
    pub fn has_yielded(&self, half_plane: &HalfPlane) -> bool {
        half_plane.violation_mps(self.plan.velocity_mps) > ROUNDING_MPS
    }

    /// Whether the planned velocity lies on a half-plane's line: without it, the plan would differ.
    pub fn binds(&self, half_plane: &HalfPlane) -> bool {
        half_plane.violation_mps(self.plan.velocity_mps).abs() <= ROUNDING_MPS
    }
}

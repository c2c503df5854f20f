//! The planners: MCN (`FbCrowd` §4) and the two baselines of Table 1, all on the same [`WorldView`].

use serde::{Deserialize, Serialize};

use crate::params::Params;
use crate::planning::baselines::orca::{self, OrcaMemory};
use crate::planning::baselines::social_force;
use crate::planning::mcn::memory::McnMemory;
use crate::planning::mcn::navigate;
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::plan::Plan;
use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;
use crate::world::neighbours::neighbour::RANKING_HORIZON_S;

/// The planner of a scenario.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Planner {
    /// Motion-constrained navigation, §4.
    #[default]
    Mcn,
    /// Optimal reciprocal collision avoidance as published: van den Berg et al. 2011.
    Orca,
    /// Social forces by the universal power law: Karamouzas, Skinner, Guy 2014.
    SocialForce,
}

/// Working memory of one thread, of every planner; kept from plan to plan.
#[derive(Clone, Debug, Default)]
pub struct PlannerMemory {
    pub(crate) mcn: McnMemory,
    pub(crate) orca: OrcaMemory,
    pub(crate) social_force: Surroundings,
}

impl PlannerMemory {
    /// The half-planes of a planner's last plan. MCN's, by rank: walls, one-way zones, stance, sharp turn, hull, agents;
    /// ORCA's: walls, one-way zones, agents; none of social forces.
    pub fn half_planes(&self, planner: Planner) -> &[HalfPlane] {
        match planner {
            Planner::Mcn => self.mcn.half_planes(),
            Planner::Orca => &self.orca.half_planes,
            Planner::SocialForce => &[],
        }
    }

    /// Bytes that the memory holds.
    pub(crate) fn size_bytes(&self) -> usize {
        size_of_val(self) + self.mcn.heap_bytes() + self.orca.heap_bytes() + self.social_force.heap_bytes()
    }
}

/// Time ahead within which a planner ranks neighbours, s; 0 ranks by distance.
pub fn ranking_horizon_s(planner: Planner, params: &Params) -> f32 {
    match planner {
        Planner::Mcn if params.planner.parts.order => RANKING_HORIZON_S,
        // As RVO2 and the authors of the power law do.
        Planner::Mcn | Planner::Orca | Planner::SocialForce => 0.0,
    }
}

/// Plans the next velocity and facing of one agent. The view's neighbours must be sorted for the planner's
/// [`ranking_horizon_s`].
pub fn plan(planner: Planner, world: &WorldView, agent: usize, params: &Params, memory: &mut PlannerMemory) -> Plan {
    match planner {
        Planner::Mcn => navigate::plan(world, agent, &params.planner, &mut memory.mcn),
        Planner::Orca => orca::plan(world, agent, &params.orca, &mut memory.orca),
        Planner::SocialForce => social_force::plan(world, agent, &params.social_force, &mut memory.social_force),
    }
}

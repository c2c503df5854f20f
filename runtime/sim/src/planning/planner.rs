//! Who plans: MCN (`FbCrowd` §4), or one of the two rivals that Table 1 sets beside it, all from the same [`World`].

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::params::Params;
use crate::planning::baselines::{orca, social_force};
use crate::planning::mcn;
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::plan::{Plan, VelocitySet};
use crate::planning::world_view::World;
use crate::world::neighbours::{AHEAD_S, Nearest, Query};
use crate::world::obstacles::NearEdge;
use crate::world::time_to_collision::disc_with_segment;

/// The planner of a scenario.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Planner {
    /// Motion-constrained navigation, §4.
    #[default]
    Mcn,
    /// Optimal reciprocal collision avoidance as it was published: van den Berg et al. 2011.
    Orca,
    /// Social forces by the universal power law: Karamouzas, Skinner, Guy 2014.
    SocialForce,
}

/// Working memory of one thread. After [`plan`] it tells why the velocity was chosen.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pub(crate) nearest: Nearest,
    pub(crate) edges: Vec<NearEdge>,
    /// Of each velocity set's program; rivals have one.
    pub(crate) half_planes: [Vec<HalfPlane>; 2],
    /// The set that was chosen.
    pub(crate) set: VelocitySet,
    pub(crate) projected: Vec<HalfPlane>,
    pub(crate) adapted_mps: Vec2,
    // MCN's own: where the body faces, and half-planes that both its velocity sets take over.
    pub(crate) forward: Vec2,
    pub(crate) of_walls: Vec<HalfPlane>,
    pub(crate) of_agents: Vec<HalfPlane>,
}

impl Scratch {
    /// The half-planes of the last plan, by rank: walls, stance, sharp turns, hull, agents by urgency. None
    /// for social forces.
    pub fn half_planes(&self) -> &[HalfPlane] {
        &self.half_planes[self.set as usize]
    }

    /// What it holds in memory, bytes.
    pub(crate) fn size_bytes(&self) -> usize {
        let [turning, holding] = &self.half_planes;
        let lists = [turning, holding, &self.projected, &self.of_walls, &self.of_agents];
        let half_planes: usize = lists.iter().map(|list| list.capacity()).sum();
        let half_planes = half_planes * size_of::<HalfPlane>();
        let edges = self.edges.capacity() * size_of::<NearEdge>();
        size_of_val(self) + self.nearest.lists_bytes() + half_planes + edges
    }
}

/// How far ahead a planner's neighbours are ranked, s.
pub fn ahead_s(planner: Planner, params: &Params) -> f32 {
    match planner {
        Planner::Mcn if params.planner.parts.order => AHEAD_S,
        // By distance: as RVO2, and the authors of the power law, do.
        Planner::Mcn | Planner::Orca | Planner::SocialForce => 0.0,
    }
}

/// Plans one agent's next velocity and facing; the world's neighbours are sorted for [`ahead_s`].
pub fn plan(planner: Planner, world: &World, agent: usize, params: &Params, scratch: &mut Scratch) -> Plan {
    match planner {
        Planner::Mcn => mcn::plan(world, agent, &params.planner, scratch),
        Planner::Orca => orca::plan(world, agent, &params.orca, scratch),
        Planner::SocialForce => social_force::plan(world, agent, &params.social_force, scratch),
    }
}

/// Finds an agent's neighbours and, nearest first, the walls' edges within `wall_range` of its disc.
pub(crate) fn look_around(world: &World, agent: usize, range_m: f32, wall_range_m: f32, scratch: &mut Scratch) {
    let own = world.disc(agent);
    let query =
        Query { agent, position_m: own.position_m, velocity_mps: own.velocity_mps, radius_m: own.radius_m, range_m };
    world.neighbours.nearest(&query, &mut scratch.nearest);
    world.obstacles.near(own.position_m, own.radius_m + wall_range_m, &mut scratch.edges);
}

/// Least time to collision, at the present velocities, with whom and what [`look_around`] found, s.
pub(crate) fn time_to_collision_s(world: &World, agent: usize, scratch: &Scratch) -> f32 {
    let own = world.disc(agent);
    let with_agents = scratch.nearest.as_slice().iter().map(|neighbour| neighbour.time_to_collision_s);
    let with_walls = scratch
        .edges
        .iter()
        .map(|near| disc_with_segment(world.edge_m(agent, near.edge), own.velocity_mps, own.radius_m));
    with_agents.chain(with_walls).fold(f32::INFINITY, f32::min)
}

//! What one agent sees: its nearest neighbours and the wall edges near its disc. World axes, metres, seconds.

use crate::planning::world_view::WorldView;
use crate::world::neighbours::{NearestNeighbours, NeighbourQuery};
use crate::world::obstacles::NearEdge;
use crate::world::time_to_collision::disc_with_segment;

/// The surroundings of one agent. Their memory is kept from agent to agent.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// The neighbours, best rank first.
    pub(crate) neighbours: NearestNeighbours,
    /// The edges of walls that face the agent, nearest first.
    pub(crate) edges: Vec<NearEdge>,
}

impl Surroundings {
    /// Finds an agent's neighbours within `range_m` and the edges within `wall_range_m` of the disc that walls hold.
    pub(crate) fn look_around(&mut self, world: &WorldView, agent: usize, range_m: f32, wall_range_m: f32) {
        let own = world.disc(agent);
        let query = NeighbourQuery {
            agent,
            position_m: own.position_m,
            velocity_mps: own.velocity_mps,
            radius_m: own.radius_m,
            range_m,
        };
        world.neighbours.nearest(&query, &mut self.neighbours);
        world.walls_of(agent).near(own.position_m, world.wall_radii_m[agent] + wall_range_m, &mut self.edges);
    }

    /// Least time to collision with a neighbour or an edge at the present velocities, s.
    pub(crate) fn time_to_collision_s(&self, world: &WorldView, agent: usize) -> f32 {
        let own = world.wall_disc(agent);
        let with_agents = self.neighbours.as_slice().iter().map(|neighbour| neighbour.time_to_collision_s);
        let with_walls = self
            .edges
            .iter()
            .map(|near| disc_with_segment(world.edge_m(agent, near.edge), own.velocity_mps, own.radius_m));
        with_agents.chain(with_walls).fold(f32::INFINITY, f32::min)
    }

    /// Bytes that the lists hold on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        self.neighbours.heap_bytes() + self.edges.capacity() * size_of::<NearEdge>()
    }
}

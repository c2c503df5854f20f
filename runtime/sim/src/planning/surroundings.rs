//! What one agent sees: its nearest neighbours and the wall edges near its disc. World axes, metres, seconds.

use glam::Vec2;

use crate::planning::elbow_room::ElbowRoom;
use crate::planning::world_view::WorldView;
use crate::world::disc::Disc;
use crate::world::neighbours::{NearestNeighbours, Neighbour, NeighbourQuery};
use crate::world::obstacles::{NearEdge, Obstacles};
use crate::world::segment::nearest_on_segment;
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
    /// Finds an agent's neighbours within `range_m`, without those that walls hide, and the edges within `wall_range_m`
    /// of the disc that walls hold.
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
        let walls = world.walls_of(agent);
        if !walls.corners().is_empty() {
            let is_seen = |neighbour: &Neighbour| {
                is_in_sight(walls, own, neighbour.offset_m, world.radii_m[neighbour.agent as usize])
            };
            self.neighbours.retain(is_seen);
        }
        walls.near(own.position_m, world.wall_radii_m[agent] + wall_range_m, &mut self.edges);
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

    /// Overlap of the agent's disc with that of the neighbour that it overlaps most, m; negative where it overlaps none.
    pub(crate) fn greatest_overlap_m(&self) -> f32 {
        let overlaps_m = self.neighbours.as_slice().iter().map(|near| near.radius_m - near.distance_m);
        overlaps_m.fold(f32::NEG_INFINITY, f32::max)
    }

    /// The room that walls and neighbours leave to the body of an agent; walls count more.
    pub(crate) fn elbow_room(&self, world: &WorldView, agent: usize) -> ElbowRoom {
        let own_m = world.radii_m[agent];
        let walls_m = self.edges.iter().map(|near| {
            let [from_m, to_m] = world.edge_m(agent, near.edge);
            nearest_on_segment(Vec2::ZERO, from_m, to_m)
        });
        let neighbours = self.neighbours.as_slice().iter();
        ElbowRoom::ending_at(neighbours.map(|near| own_m / near.radius_m * near.offset_m).chain(walls_m))
    }

    /// Bytes that the lists hold on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        self.neighbours.heap_bytes() + self.edges.capacity() * size_of::<NearEdge>()
    }
}

/// Whether an agent sees any of the disc of another: the line between their centres, or one of the lines between their
/// edges on either side, crosses no wall.
fn is_in_sight(walls: &Obstacles, own: Disc, offset_m: Vec2, radius_m: f32) -> bool {
    let across = offset_m.perp().normalize_or_zero();
    [0.0, 1.0, -1.0].into_iter().any(|side| {
        let from_m = own.position_m + side * own.radius_m * across;
        walls.is_free(from_m, own.position_m + offset_m + side * radius_m * across)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_hide_agents() {
        let wall_m = [[1.0, -3.0], [1.2, -3.0], [1.2, 3.0], [1.0, 3.0]].map(Vec2::from).to_vec();
        let walls = Obstacles::new(&[wall_m]);
        let own = |y: f32| Disc { position_m: Vec2::new(0.0, y), velocity_mps: Vec2::ZERO, radius_m: 0.25 };
        let sees = |y: f32, offset_m: [f32; 2]| is_in_sight(&walls, own(y), Vec2::from(offset_m), 0.25);
        assert!(!sees(0.0, [2.0, 0.0]) && !sees(2.7, [2.0, 0.0]), "behind the wall");
        assert!(sees(2.8, [2.0, 0.0]), "an edge of the disc is past the end of the wall");
        assert!(sees(0.0, [0.5, 2.0]) && sees(4.0, [2.0, 0.0]), "nothing is between them");
    }
}

//! The plan of a baseline: its velocity, the facing along it, and what Eq. 1 reads. World axes, m/s, radians.

use glam::Vec2;

use crate::planning::mcn::density_filter::density_ahead;
use crate::planning::mcn::orientation::stands;
use crate::planning::plan::Plan;
use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;

/// A plan that faces along its velocity; an agent that stands keeps its facing.
pub(crate) fn facing_along(velocity_mps: Vec2, world: &WorldView, agent: usize, surroundings: &Surroundings) -> Plan {
    let facing_rad =
        if stands(velocity_mps) { world.facings_rad[agent] } else { libm::atan2f(velocity_mps.y, velocity_mps.x) };
    let ahead = world.preferred_direction(agent);
    Plan {
        velocity_mps,
        facing_rad,
        time_to_collision_s: surroundings.time_to_collision_s(world, agent),
        density: density_ahead(ahead, surroundings.neighbours.lanes()),
        room: surroundings.elbow_room(world, agent),
        ..Plan::default()
    }
}

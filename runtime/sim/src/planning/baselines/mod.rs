//! The planners that the paper compares MCN with (`FbCrowd` §7, Table 1), as their authors published them.
//!
//! Neither knows of bodies: a plan is a velocity, and the facing follows it. What Eq. 1 asks for, time to collision and
//! density, is told as MCN tells it, so that the same bodies follow.

pub(crate) mod orca;
pub(crate) mod social_force;

pub use orca::OrcaParams;
pub use social_force::{Force, SocialForceParams};

use glam::Vec2;

use crate::planning::mcn::density::density_ahead;
use crate::planning::mcn::orientation::stands;
use crate::planning::plan::Plan;
use crate::planning::planner::{Scratch, time_to_collision_s};
use crate::planning::world_view::World;

/// Walks at a velocity, facing along it; who stands keeps its facing.
fn facing_the_way(world: &World, agent: usize, velocity_mps: Vec2, scratch: &Scratch) -> Plan {
    Plan {
        velocity_mps,
        facing_rad: if stands(velocity_mps) {
            world.facings_rad[agent]
        } else {
            libm::atan2f(velocity_mps.y, velocity_mps.x)
        },
        time_to_collision_s: time_to_collision_s(world, agent, scratch),
        density: density_ahead(scratch.adapted_mps.normalize_or_zero(), scratch.nearest.around()),
        ..Plan::default()
    }
}

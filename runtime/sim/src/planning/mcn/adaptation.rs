//! v_op: the preferred velocity, adapted to the crowd (`FbCrowd` §4.3, App. 9.1, Eq. 9).
//!
//! Eq. 9 begins at the last plan and acts for one step, so that an agent speeds up and slows down by no more than people
//! do at ease; half-planes may demand more. Masses are 1, so forces are accelerations. World axes, m/s and m/s².

use glam::Vec2;

use crate::planning::mcn::memory::McnMemory;
use crate::planning::mcn::params::McnParams;
use crate::planning::mcn::turn_first::slowed_to_turn;
use crate::planning::mcn::{density_filter, keep_right, power_law};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;
use crate::world::neighbours::neighbour_lanes::Lanes;

/// Computes v_op into the memory. Returns the density ahead, 1/m.
///
/// 1. v_pref turns to the right of agents that come, and slows down while the body turns to it;
/// 2. driving force and social forces act for one step (Eq. 9);
/// 3. the density filter limits the speed.
pub(crate) fn adapt(world: &WorldView, agent: usize, params: &McnParams, memory: &mut McnMemory) -> f32 {
    let (velocity_mps, mut adapted_mps) = (followed_mps(world, agent, params), world.preferred_mps[agent]);
    let neighbours = memory.surroundings.neighbours.lanes();
    let shares = world.shares(agent, memory.surroundings.neighbours.as_slice());
    if params.parts.keep_right {
        adapted_mps = keep_right::kept_right(adapted_mps, velocity_mps, neighbours, &shares, params);
    }
    if params.parts.turn_first && world.bodies {
        adapted_mps = slowed_to_turn(world.forward(agent), world.along_route_mps(agent), adapted_mps);
    }
    if params.parts.adaptation {
        let forces_mps2 = forces_mps2(world, agent, &shares, params, memory);
        adapted_mps = pushed_mps(velocity_mps, adapted_mps, forces_mps2, world.dt_s, params);
    }
    let filtered = density_filter::filter(adapted_mps, velocity_mps, neighbours, world.dt_s, params);
    memory.adapted_mps = if params.parts.density_filter { filtered.velocity_mps } else { adapted_mps };
    filtered.density
}

/// The velocity on which Eq. 9 acts, m/s: the last plan, which a body follows with a lag.
///
/// From the velocity of the body itself, a step would add almost nothing: a body that stands would never start. The
/// plan of a body that is held up stays near its velocity: it is ahead by no more than Eq. 9 adds within the lag.
fn followed_mps(world: &WorldView, agent: usize, params: &McnParams) -> Vec2 {
    let (velocity_mps, planned_mps) = (world.velocities_mps[agent], world.planned_mps[agent]);
    let ahead_max_mps = params.response_s * params.acceleration_max_mps2;
    velocity_mps + (planned_mps - velocity_mps).clamp_length_max(ahead_max_mps)
}

/// Eq. 9, one explicit step of `dt_s`, with limited acceleration; `forces_mps2` is Σ f_ij + Σ f_iW.
fn pushed_mps(velocity_mps: Vec2, preferred_mps: Vec2, forces_mps2: Vec2, dt_s: f32, params: &McnParams) -> Vec2 {
    let driving_mps2 = (preferred_mps - velocity_mps) / params.relaxation_s;
    let acceleration_mps2 = (driving_mps2 + forces_mps2).clamp_length_max(params.acceleration_max_mps2);
    velocity_mps + dt_s * acceleration_mps2 // Eq. 9
}

/// Σ f_ij + Σ f_iW; f_ij by the agent's share of the avoiding.
fn forces_mps2(world: &WorldView, agent: usize, shares: &Lanes, params: &McnParams, memory: &McnMemory) -> Vec2 {
    let (own, law) = (world.wall_disc(agent), params.power_law());
    let meets = |(neighbour, _): &(&Neighbour, _)| neighbour.time_to_collision_s.is_finite();
    let neighbours = memory.surroundings.neighbours.as_slice().iter().zip(shares);
    let of_agents = neighbours.filter(meets).map(|(&Neighbour { offset_m, relative_mps, radius_m, .. }, &share)| {
        2.0 * share * power_law::agent_force_mps2(offset_m, relative_mps, radius_m, &law)
    });
    let of_walls =
        memory.surroundings.edges.iter().map(|near| {
            power_law::wall_force_mps2(world.edge_m(agent, near.edge), own.velocity_mps, own.radius_m, &law)
        });
    of_agents.chain(of_walls).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_forces_the_driving_force_acts_alone() {
        let pushed_mps = pushed_mps(Vec2::X, Vec2::new(1.0, 0.4), Vec2::ZERO, 0.1, &McnParams::default());
        assert!(pushed_mps.distance(Vec2::new(1.0, 0.1)) < 1e-6);
    }
}

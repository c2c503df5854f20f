//! v_op: the preferred velocity, adapted to the crowd (`FbCrowd` §4.3, App. 9.1, Eq. 9).
//!
//! Eq. 9 begins at the last plan and acts for one step, so that an agent speeds up and slows down by no more than
//! people do at ease; half-planes may demand more. By Eq. 9 an agent that wants to stand would slow down for ever; here
//! it comes to rest. Masses are 1, so forces are accelerations. World axes, m/s and m/s².

use glam::Vec2;

use crate::planning::mcn::memory::McnMemory;
use crate::planning::mcn::params::McnParams;
use crate::planning::mcn::turn_first::slowed_to_turn;
use crate::planning::mcn::{density_filter, keep_right, power_law};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;
use crate::world::neighbours::neighbour_lanes::Lanes;

/// Least deceleration of an agent that wants to stand and that no force moves, m/s² (docs/tuning.md).
const RESTING_MPS2: f32 = 0.5;

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
    let change_mps = preferred_mps - velocity_mps;
    let mut driving_mps2 = change_mps / params.relaxation_s;
    if preferred_mps == Vec2::ZERO {
        // Social forces still move it.
        let least_mps2 = (RESTING_MPS2 - forces_mps2.length()).max(0.0);
        driving_mps2 = driving_mps2.clamp_length_min(least_mps2.min(change_mps.length() / dt_s));
    }
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

    #[test]
    fn an_agent_that_wants_to_stand_comes_to_rest() {
        let (dt_s, params) = (0.1, McnParams::default());
        let slower_mps = |mps: Vec2| pushed_mps(mps, Vec2::ZERO, Vec2::ZERO, dt_s, &params);
        assert!(slower_mps(Vec2::X).distance(0.8 * Vec2::X) < 1e-5);
        assert!(slower_mps(0.1 * Vec2::Y).distance(0.05 * Vec2::Y) < 1e-6);
        assert!(slower_mps(0.04 * Vec2::Y).length() < 1e-6 && slower_mps(Vec2::ZERO) == Vec2::ZERO);
    }

    #[test]
    fn an_agent_that_wants_to_stand_gives_way_alike_in_any_step() {
        let yielded_mps = |dt_s: f32| {
            let pushed = |mps: Vec2, _| pushed_mps(mps, Vec2::ZERO, 0.3 * Vec2::X, dt_s, &McnParams::default());
            (0..(3.0 / dt_s) as usize).fold(Vec2::ZERO, pushed).x
        };
        let [fine_mps, coarse_mps] = [1.0 / 60.0, 0.1].map(yielded_mps);
        assert!(fine_mps > 0.1 && (fine_mps - coarse_mps).abs() < 0.01, "{fine_mps} {coarse_mps}");
    }
}

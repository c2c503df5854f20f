//! The half-planes of walls and agents, C_collision (`FbCrowd` §4.4, Eq. 12), with MCN's shares, horizons and weights.
//!
//! World axes, metres, seconds.

use glam::Vec2;

use crate::planning::mcn::avoidance::pressing::{greatest_conflict, with_pressing};
use crate::planning::mcn::avoidance::queueing::{back_min_mps, queue_half_plane, queueing_share};
use crate::planning::mcn::avoidance::slowing::with_slowing;
use crate::planning::mcn::memory::McnMemory;
use crate::planning::mcn::params::{McnParams, McnParts};
use crate::planning::orca::agent_half_planes::{EQUAL_SHARE, agent_half_plane, shares};
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::orca::wall_half_planes::wall_half_planes;
use crate::planning::world_view::WorldView;
use crate::world::disc::Disc;
use crate::world::neighbours::Neighbour;
use crate::world::neighbours::neighbour_lanes::{LANES, Lanes, NeighbourLanes};

/// Speed from which an agent counts as walking, m/s: a slow walk. At half of it, one agent in two hundred that stand
/// 0.8 m apart does not arrive.
const SLOW_WALK_MPS: f32 = 0.6;
/// Time to contact at which an agent's urgency falls to one half, s: a walker's reaction time. The result depends
/// little on it (docs/tuning.md).
const REACTION_S: f32 = 0.3;
/// Speed at which an agent that keeps its distance might approach, m/s.
const APPROACH_MPS: f32 = 1.0;
/// Least time within which overlapping discs part, s: within a finer step they would part at speeds that no body
/// follows (docs/tuning.md).
const PARTING_MIN_S: f32 = 0.05;
/// Distance that a disc keeps from walls, m: a body's root leaves its plan by about a centimetre, and would touch a
/// corner that its disc grazes. With it, walls hold no disc in `fbcrowd bench course`.
const WALL_MARGIN_M: f32 = 0.012;

/// Eq. 12: computes the half-planes of walls, agents and the queue into the memory, and the speed below which the body
/// waits.
pub(crate) fn avoid(world: &WorldView, agent: usize, params: &McnParams, memory: &mut McnMemory) {
    let own = world.disc(agent);
    memory.of_walls.clear();
    let (edges, horizon_s) = (&memory.surroundings.edges, params.obstacle_time_horizon_s);
    let wider = Disc { radius_m: world.wall_radii_m[agent] + WALL_MARGIN_M, ..own };
    wall_half_planes(world.walls_of(agent), edges, &wider, horizon_s, &mut memory.of_walls); // ∪_W C_iW
    // Shares, weights and horizons are computed for all neighbours at once.
    let neighbours = &memory.surroundings.neighbours;
    let lanes = neighbours.lanes();
    let shares = if params.parts.keep_right { shares(own.velocity_mps, lanes) } else { [EQUAL_SHARE; LANES] };
    let of_priority = world.shares(agent, neighbours.as_slice());
    let weights = if params.parts.order { urgencies(lanes) } else { [1.0; LANES] };
    let horizons_s = horizons_s(own.velocity_mps, lanes, params);
    let parting_s = world.dt_s.max(PARTING_MIN_S);
    memory.of_agents.clear();
    memory.of_agents.extend(neighbours.as_slice().iter().enumerate().map(|(lane, neighbour)| {
        let (share, horizon_s) = (shares[lane] + (of_priority[lane] - EQUAL_SHARE), horizons_s[lane]);
        let share = share.clamp(0.0, 1.0);
        let (own_mps, neighbour) = with_gains(world, agent, neighbour, &params.parts);
        let half_plane = agent_half_plane(own_mps, &neighbour, share, horizon_s, parting_s); // ∪_j C_ij
        HalfPlane { weight: weights[lane], ..half_plane }
    }));
    memory.back_min_mps = 0.0;
    if params.parts.queueing {
        let neighbours = neighbours.as_slice();
        let share = queueing_share(world, agent, neighbours, &weights);
        let conflict = if params.parts.pressing { greatest_conflict(world, agent, neighbours) } else { 0.0 };
        memory.back_min_mps = back_min_mps(share, conflict);
        memory.of_agents.extend(queue_half_plane(world, agent, share));
    }
}

/// An agent's velocity, and one of its neighbours, as half-planes take them: with what both gain by right of way, by
/// slowing and by pressing, in this order.
#[inline(always)]
fn with_gains(world: &WorldView, agent: usize, neighbour: &Neighbour, parts: &McnParts) -> (Vec2, Neighbour) {
    let (mut own_mps, mut neighbour) = world.with_right_of_way(agent, neighbour);
    if parts.slowing {
        (own_mps, neighbour) = with_slowing(world, agent, own_mps, &neighbour);
    }
    if parts.pressing {
        (own_mps, neighbour) = with_pressing(world, agent, own_mps, &neighbour);
    }
    (own_mps, neighbour)
}

/// τ against each neighbour, s. One that stands is a wall, and is avoided no earlier: at rest it bounds the approach to
/// gap/τ, so with the full τ no agent gets through the gaps between agents that stand at their goals.
fn horizons_s(own_mps: Vec2, neighbours: &NeighbourLanes, params: &McnParams) -> Lanes {
    std::array::from_fn(|lane| {
        let other_mps = own_mps - neighbours.relative_mps(lane);
        let walks = (other_mps.length_squared().sqrt() / SLOW_WALK_MPS).min(1.0);
        params.obstacle_time_horizon_s + walks * (params.time_horizon_s - params.obstacle_time_horizon_s)
    })
}

/// Weights that order the agents (App. 9.4): 1 in contact, less for later contact.
///
/// The time to contact is that of an approach straight on. The time to collision itself jumps to infinity as soon as
/// the agents avoid each other.
fn urgencies(neighbours: &NeighbourLanes) -> Lanes {
    std::array::from_fn(|lane| {
        let offset_m = neighbours.offset_m(lane);
        let distance_m = offset_m.length_squared().sqrt();
        let gap_m = (distance_m - neighbours.radius_m[lane]).max(0.0);
        let closing = neighbours.relative_mps(lane).dot(offset_m) / distance_m.max(f32::MIN_POSITIVE);
        REACTION_S / (REACTION_S + gap_m / (closing.max(0.0) + APPROACH_MPS))
    })
}

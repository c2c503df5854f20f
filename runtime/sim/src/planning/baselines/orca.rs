//! ORCA as published (van den Berg, Guy, Lin, Manocha 2011) and as the RVO2 library implements it.
//!
//! The nearest ten by distance, equal shares, v_pref as it is, and a disc of the greatest speed as the only limit of
//! the body. Where the agents' half-planes are infeasible, the 3D program takes the velocity that violates them least,
//! all with equal weight; walls stay hard. World axes, metres, seconds.

use serde::{Deserialize, Serialize};

use crate::planning::baselines::facing::facing_along;
use crate::planning::orca::agent_half_planes::agent_half_plane;
use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::orca::linear_program::solve;
use crate::planning::orca::wall_half_planes::wall_half_planes;
use crate::planning::plan::Plan;
use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;

/// Tunables of plain ORCA, `[params.orca]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OrcaParams {
    /// τ: time ahead within which agents avoid each other, s.
    pub time_horizon_s: f32,
    /// Time ahead within which walls are avoided, s.
    pub obstacle_time_horizon_s: f32,
    /// Farthest neighbour, m.
    pub neighbour_range_m: f32,
    /// Greatest speed, m/s.
    pub speed_max_mps: f32,
}

impl Default for OrcaParams {
    fn default() -> Self {
        Self {
            // The protocol under which RVO2 was measured (`fbcrowd bench table1 --discs`).
            time_horizon_s: 5.0,
            neighbour_range_m: 10.0,
            speed_max_mps: 2.0,
            // The protocol has no walls. As MCN's, so that doors are equally wide for both.
            obstacle_time_horizon_s: 1.0,
        }
    }
}

/// Working memory of ORCA.
#[derive(Clone, Debug, Default)]
pub(crate) struct OrcaMemory {
    pub(crate) surroundings: Surroundings,
    /// Half-planes of the last plan: walls, one-way zones, agents.
    pub(crate) half_planes: Vec<HalfPlane>,
    /// Working memory of the 3D program.
    projected: Vec<HalfPlane>,
}

impl OrcaMemory {
    /// Bytes that the lists hold on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        let half_planes = self.half_planes.capacity() + self.projected.capacity();
        self.surroundings.heap_bytes() + half_planes * size_of::<HalfPlane>()
    }
}

/// Plans the next velocity of one agent; its facing follows.
pub(crate) fn plan(world: &WorldView, agent: usize, params: &OrcaParams, memory: &mut OrcaMemory) -> Plan {
    let OrcaMemory { surroundings, half_planes, projected } = memory;
    let wall_range_m = params.obstacle_time_horizon_s * params.speed_max_mps;
    surroundings.look_around(world, agent, params.neighbour_range_m, wall_range_m);
    half_planes.clear();
    let held = world.wall_disc(agent);
    wall_half_planes(world.walls_of(agent), &surroundings.edges, &held, params.obstacle_time_horizon_s, half_planes);
    half_planes.extend(world.one_way_half_planes(agent));
    let firm_count = half_planes.len();
    let neighbours = surroundings.neighbours.as_slice();
    let shares = world.shares(agent, neighbours);
    half_planes.extend(neighbours.iter().zip(shares).map(|(neighbour, share)| {
        let (own_mps, neighbour) = world.with_right_of_way(agent, neighbour);
        agent_half_plane(own_mps, &neighbour, share, params.time_horizon_s, world.dt_s)
    }));
    let preferred_mps = world.preferred_mps[agent];
    let solution = solve(half_planes, firm_count, preferred_mps, params.speed_max_mps, projected);
    facing_along(solution.velocity_mps, world, agent, surroundings)
}

//! ORCA as published (van den Berg, Guy, Lin, Manocha 2011) and as the RVO2 library does it.
//!
//! The nearest ten by distance, each half-plane shared half and half; v_pref is what is wanted, and a disc of the
//! greatest speed all that the body allows. Where the agents' half-planes leave nothing, the 3D program takes the
//! velocity that violates them least, all alike; walls stay hard. World axes, metres, seconds.

use serde::{Deserialize, Serialize};

use crate::planning::baselines::facing_the_way;
use crate::planning::orca::agents::{HALF, agent_half_plane};
use crate::planning::orca::linear_program::solve;
use crate::planning::orca::walls::obstacle_half_planes;
use crate::planning::plan::{Plan, VelocitySet};
use crate::planning::planner::{Scratch, look_around};
use crate::planning::world_view::World;

/// Tunables of plain ORCA, `[params.orca]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OrcaParams {
    /// τ: how far ahead agents avoid each other, s.
    pub time_horizon_s: f32,
    /// How far ahead walls are avoided, s.
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
            // The protocol has no walls. As MCN's, so that doors are as wide for both.
            obstacle_time_horizon_s: 1.0,
        }
    }
}

/// Plans one agent's next velocity; its facing follows.
pub(crate) fn plan(world: &World, agent: usize, params: &OrcaParams, scratch: &mut Scratch) -> Plan {
    let wall_range_m = params.obstacle_time_horizon_s * params.speed_max_mps;
    look_around(world, agent, params.neighbour_range_m, wall_range_m, scratch);
    let own = world.disc(agent);
    scratch.set = VelocitySet::Turning;
    let half_planes = &mut scratch.half_planes[scratch.set as usize];
    half_planes.clear();
    obstacle_half_planes(world.obstacles, &scratch.edges, &own, params.obstacle_time_horizon_s, half_planes);
    let walls = half_planes.len();
    half_planes.extend(
        scratch
            .nearest
            .as_slice()
            .iter()
            .map(|neighbour| agent_half_plane(own.velocity_mps, neighbour, HALF, params.time_horizon_s, world.dt_s)),
    );
    scratch.adapted_mps = world.preferred_mps[agent];
    let solution = solve(half_planes, walls, scratch.adapted_mps, params.speed_max_mps, &mut scratch.projected);
    facing_the_way(world, agent, solution.velocity_mps, scratch)
}

//! Social forces as an integrator: the universal power law of Karamouzas, Skinner, Guy 2014.
//!
//! ```text
//! dv/dt = clamp( (v_pref − v)/T + Σ_j f_ij + Σ_W f_iW )
//! ```
//!
//! by explicit Euler steps over [`World::lead_s`], from everybody within range. The law is stiff: its authors step by
//! 5 ms, and at 0.1 s it shakes. A step may therefore be cut into sub-steps, in which the others move on as they did.
//! Whoever is within range is searched for among all agents, which suits crowds of the size that Table 1 has. World
//! axes, metres, seconds; masses are 1.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use super::facing_the_way;
use crate::mcn::half_plane::Source;
use crate::mcn::orca::Disc;
use crate::mcn::social_force::{PowerLaw, agent_force_mps2, wall_force_mps2};
use crate::plan::{Plan, VelocitySet};
use crate::planner::{Scratch, look_around};
use crate::world::World;

/// Bodies take up a plan within about this time, s (`hms::intention`): the step of the paper's Table 1.
pub const TAKEN_UP_S: f32 = 0.1;

/// Tunables of social forces, `[params.social_force]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SocialForceParams {
    /// k, m²: strength of the interaction.
    pub interaction_strength: f32,
    /// τ_0, s: interactions that lie farther ahead fade.
    pub interaction_horizon_s: f32,
    /// T, s: time in which v_pref is taken up.
    pub relaxation_s: f32,
    /// Greatest sum of all forces, the driving one included, m/s².
    pub acceleration_max_mps2: f32,
    /// Farthest neighbour and wall, m.
    pub neighbour_range_m: f32,
    /// Euler steps that a step is cut into.
    pub substeps: u32,
}

impl Default for SocialForceParams {
    fn default() -> Self {
        Self {
            // Karamouzas, Skinner, Guy 2014, and their published code.
            interaction_strength: 1.5,
            interaction_horizon_s: 3.0,
            relaxation_s: 0.54,
            acceleration_max_mps2: 20.0,
            neighbour_range_m: 10.0,
            // At the step itself, as the paper's Table 1 has it.
            substeps: 1,
        }
    }
}

/// A push, and who or what pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force {
    /// An agent or an obstacle.
    pub source: Source,
    /// World axes, m/s².
    pub acceleration_mps2: Vec2,
}

/// Plans one agent's next velocity; its facing follows.
pub fn plan(world: &World, agent: usize, params: &SocialForceParams, scratch: &mut Scratch) -> Plan {
    let range_m = params.neighbour_range_m;
    look_around(world, agent, range_m, range_m, scratch);
    scratch.set = VelocitySet::Turning;
    scratch.half_planes[scratch.set as usize].clear();
    scratch.adapted_mps = world.preferred_mps[agent];
    let substep_s = world.lead_s(TAKEN_UP_S) / params.substeps as f32;
    let mut own = world.disc(agent);
    for substep in 0..params.substeps {
        let forces = forces_on(world, agent, &own, substep as f32 * substep_s, params, scratch);
        let forces_mps2: Vec2 = forces.map(|force| force.acceleration_mps2).sum();
        let driving_mps2 = (world.preferred_mps[agent] - own.velocity_mps) / params.relaxation_s;
        let acceleration_mps2 = (driving_mps2 + forces_mps2).clamp_length_max(params.acceleration_max_mps2);
        own.velocity_mps += substep_s * acceleration_mps2;
        own.position_m += substep_s * own.velocity_mps;
    }
    facing_the_way(world, agent, own.velocity_mps, scratch)
}

/// f_ij and f_iW on an agent as a step begins.
pub(crate) fn forces(world: &World, agent: usize, params: &SocialForceParams, scratch: &Scratch) -> Vec<Force> {
    forces_on(world, agent, &world.disc(agent), 0.0, params, scratch).collect()
}

/// f_ij and f_iW on the agent's disc, `later` into the step.
fn forces_on(
    world: &World,
    agent: usize,
    own: &Disc,
    later_s: f32,
    params: &SocialForceParams,
    scratch: &Scratch,
) -> impl Iterator<Item = Force> {
    let law = PowerLaw { strength: params.interaction_strength, horizon_s: params.interaction_horizon_s };
    let moved_m = own.position_m - world.positions_m[agent];
    let near = move |other: &usize| {
        *other != agent && world.positions_m[*other].distance(world.positions_m[agent]) < params.neighbour_range_m
    };
    let of_agents = (0..world.positions_m.len()).filter(near).map(move |index| {
        let other = world.disc(index);
        let offset_m = other.position_m + later_s * other.velocity_mps - own.position_m;
        let (velocity_mps, radius_m) = (own.velocity_mps - other.velocity_mps, own.radius_m + other.radius_m);
        let acceleration_mps2 = agent_force_mps2(offset_m, velocity_mps, radius_m, &law);
        Force { source: Source::Agent(index as u32), acceleration_mps2 }
    });
    let of_walls = scratch.edges.iter().map(move |near| {
        let ends_m = world.edge_m(agent, near.edge).map(|end_m| end_m - moved_m);
        let acceleration_mps2 = wall_force_mps2(ends_m, own.velocity_mps, own.radius_m, &law);
        Force { source: Source::Obstacle(near.edge), acceleration_mps2 }
    });
    of_agents.chain(of_walls)
}

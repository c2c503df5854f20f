//! Social forces as an integrator: the universal power law of Karamouzas, Skinner, Guy 2014.
//!
//! ```text
//! dv/dt = clamp( (v_pref − v)/T + Σ_j f_ij + Σ_W f_iW )
//! ```
//!
//! by explicit Euler steps over [`WorldView::lead_s`], with all agents within range. The law is stiff: its authors step
//! by 5 ms, and at 0.1 s it shakes. A step may therefore be divided into sub-steps, in which the other agents keep
//! their velocities. Agents within range are searched among all agents, which suits crowds of Table 1's size. World
//! axes, metres, seconds; masses are 1.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::planning::baselines::facing::facing_along;
use crate::planning::mcn::power_law::{PowerLaw, agent_force_mps2, wall_force_mps2};
use crate::planning::orca::half_plane::HalfPlaneSource;
use crate::planning::plan::Plan;
use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;
use crate::world::disc::Disc;
use crate::world::one_way::not_against_mps;

/// Time in which bodies take up a plan, about, s (`synthesis::command`): the step of the paper's Table 1.
pub const RESPONSE_S: f32 = 0.1;

/// Tunables of social forces, `[params.social_force]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SocialForceParams {
    /// k: strength of the interaction, m².
    pub interaction_strength: f32,
    /// τ_0: time ahead beyond which interactions fade, s.
    pub interaction_horizon_s: f32,
    /// T: time in which v_pref is taken up, s.
    pub relaxation_s: f32,
    /// Greatest sum of all forces, the driving one included, m/s².
    pub acceleration_max_mps2: f32,
    /// Farthest neighbour and wall, m.
    pub neighbour_range_m: f32,
    /// Number of Euler steps per step.
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
            // The step itself, as in the paper's Table 1.
            substeps: 1,
        }
    }
}

/// A force on an agent, and its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force {
    /// The agent or the obstacle that pushes.
    pub source: HalfPlaneSource,
    /// Force over mass, world, m/s².
    pub acceleration_mps2: Vec2,
}

/// Plans the next velocity of one agent; its facing follows.
pub(crate) fn plan(
    world: &WorldView,
    agent: usize,
    params: &SocialForceParams,
    surroundings: &mut Surroundings,
) -> Plan {
    let range_m = params.neighbour_range_m;
    surroundings.look_around(world, agent, range_m, range_m);
    let substep_s = world.lead_s(RESPONSE_S) / params.substeps as f32;
    let mut own = world.disc(agent);
    for substep in 0..params.substeps {
        let forces = forces_on(world, agent, &own, substep as f32 * substep_s, params, surroundings);
        let forces_mps2: Vec2 = forces.map(|force| force.acceleration_mps2).sum();
        let driving_mps2 = (world.preferred_mps[agent] - own.velocity_mps) / params.relaxation_s;
        let acceleration_mps2 = (driving_mps2 + forces_mps2).clamp_length_max(params.acceleration_max_mps2);
        let velocity_mps = own.velocity_mps + substep_s * acceleration_mps2;
        own.velocity_mps = not_against_mps(world.one_way, own.position_m, velocity_mps);
        own.position_m += substep_s * own.velocity_mps;
    }
    facing_along(own.velocity_mps, world, agent, surroundings)
}

/// f_ij and f_iW on an agent at the start of a step.
pub(crate) fn forces(
    world: &WorldView,
    agent: usize,
    params: &SocialForceParams,
    surroundings: &Surroundings,
) -> Vec<Force> {
    forces_on(world, agent, &world.disc(agent), 0.0, params, surroundings).collect()
}

/// f_ij and f_iW on the agent's disc, `elapsed_s` into the step.
fn forces_on(
    world: &WorldView,
    agent: usize,
    own: &Disc,
    elapsed_s: f32,
    params: &SocialForceParams,
    surroundings: &Surroundings,
) -> impl Iterator<Item = Force> {
    let law = PowerLaw { strength: params.interaction_strength, horizon_s: params.interaction_horizon_s };
    let moved_m = own.position_m - world.positions_m[agent];
    let near = move |other: &usize| {
        *other != agent && world.positions_m[*other].distance(world.positions_m[agent]) < params.neighbour_range_m
    };
    let of_agents = (0..world.positions_m.len()).filter(near).map(move |index| {
        let other = world.disc(index);
        let offset_m = other.position_m + elapsed_s * other.velocity_mps - own.position_m;
        let (relative_mps, radius_m) = (own.velocity_mps - other.velocity_mps, own.radius_m + other.radius_m);
        let acceleration_mps2 = agent_force_mps2(offset_m, relative_mps, radius_m, &law);
        Force { source: HalfPlaneSource::Agent(index as u32), acceleration_mps2 }
    });
    let of_walls = surroundings.edges.iter().map(move |near| {
        let ends_m = world.edge_m(agent, near.edge).map(|end_m| end_m - moved_m);
        let acceleration_mps2 = wall_force_mps2(ends_m, own.velocity_mps, world.wall_radii_m[agent], &law);
        Force { source: HalfPlaneSource::Obstacle(near.edge), acceleration_mps2 }
    });
    of_agents.chain(of_walls)
}

//! One agent's plan by MCN, in the order of the paper (`FbCrowd` §4).
//!
//! It reads a frozen [`WorldView`] and writes only its [`McnMemory`], so agents may be planned in any order and on any
//! thread. World axes, metres, seconds, radians.

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::Construction;

use crate::planning::gap::gap_m;
use crate::planning::mcn::adaptation::adapt;
use crate::planning::mcn::avoidance::{avoid, stays, waits};
use crate::planning::mcn::gradual_turn::TurningBody;
use crate::planning::mcn::memory::McnMemory;
use crate::planning::mcn::orientation::{self, Orientation, OrientationInput};
use crate::planning::mcn::params::{McnParams, StanceForm};
use crate::planning::mcn::stance_half_plane::{radial_segment_m, stance_half_plane};
use crate::planning::mcn::turn_first::turning_along_route;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::orca::linear_program;
use crate::planning::orca::wall_half_planes::segment_half_plane;
use crate::planning::plan::{Plan, VelocitySet};
use crate::planning::world_view::WorldView;

/// Greatest speed at which walls ahead are looked for, m/s: a run.
const WALL_SPEED_MPS: f32 = 4.0;

/// Greatest speed of an agent that gives way, divided by the speed that it prefers (Helbing and Molnár 1995, *Physical
/// Review E* 51, 4282–4286).
const HURRY: f32 = 1.3;
/// Speed up to which an agent of common size always may give way, m/s: a brisk walk.
const BRISK_MPS: f32 = 1.5;

/// Speed of a side-step by which a body is known to have side-steps, m/s: a slow one.
const ASIDE_MPS: f32 = 0.3;

/// Plans one agent's next velocity and facing.
///
/// 1. Look around: neighbours and wall edges.
/// 2. Adapt v_pref to the crowd: v_op (§4.3).
/// 3. Find the half-planes of walls and agents (§4.4).
/// 4. Solve for the velocity in the turning set; in the holding set where the agent would stand (§4.1, 4.2, 4.4). Nobody
///    runs to give way.
/// 5. Choose the facing, and with it the velocity set (§4.5); a body turns to it gradually.
/// 6. Measure the gap that the agent passes, and the room that its body has.
pub(crate) fn plan(world: &WorldView, agent: usize, params: &McnParams, memory: &mut McnMemory) -> Plan {
    let wall_range_m = params.obstacle_time_horizon_s * WALL_SPEED_MPS;
    memory.surroundings.look_around(world, agent, params.neighbour_range_m, wall_range_m);
    let density = adapt(world, agent, params, memory);
    avoid(world, agent, params, memory);
    memory.forward = world.forward(agent);
    let turning_mps = solve(world, agent, VelocitySet::Turning, params, memory);
    // An agent that would stand tries to side-step: a narrow turning set leaves nothing before a wall, or another
    // agent, that the facing meets obliquely.
    let would_stand = orientation::stands(turning_mps) && !orientation::stands(memory.adapted_mps);
    let holding_mps = would_stand.then(|| solve(world, agent, VelocitySet::Holding, params, memory));
    let orientation = orient(world, agent, holding_mps.unwrap_or(turning_mps), params, memory);
    memory.set = orientation.set;
    let velocity_mps = match orientation.set {
        VelocitySet::Turning => turning_mps,
        VelocitySet::Holding => {
            holding_mps.unwrap_or_else(|| solve(world, agent, VelocitySet::Holding, params, memory))
        }
    };
    let facing = if world.bodies {
        turning_body(world, agent, orientation.facing, params, memory)
            .gradual_facing(memory.forward, orientation.facing)
    } else {
        orientation.facing
    };
    Plan {
        velocity_mps,
        waits: waits(world, agent, memory, velocity_mps) || stays(world, agent, &memory.surroundings, velocity_mps),
        facing_rad: libm::atan2f(facing.y, facing.x),
        time_to_collision_s: memory.surroundings.time_to_collision_s(world, agent),
        density,
        set: orientation.set,
        strafing_s: orientation.strafing_s,
        stepping_back_s: orientation.stepping_back_s,
        gap_m: gap_m(world, agent, velocity_mps, &memory.surroundings),
        room: memory.surroundings.elbow_room(world, agent),
    }
}

/// What the turn of an agent's body to a facing depends on.
fn turning_body(world: &WorldView, agent: usize, facing: Vec2, params: &McnParams, memory: &McnMemory) -> TurningBody {
    let turns_first = if params.parts.turn_first {
        turning_along_route(memory.forward, facing, world.along_route_mps(agent))
    } else {
        0.0
    };
    let speed_mps = world.velocities_mps[agent].length();
    TurningBody { speed_mps, steps_aside: steps_aside(world, agent, memory.forward), turns_first }
}

/// Whether an agent's body has side-steps to both sides.
fn steps_aside(world: &WorldView, agent: usize, forward: Vec2) -> bool {
    let (holding, factor) = (world.constraints_of(agent).set(VelocitySet::Holding), world.speed_factor(agent));
    [ASIDE_MPS, -ASIDE_MPS].into_iter().all(|aside_mps| {
        holding.outside_mps(forward, factor, factor * aside_mps * forward.perp()) <= orientation::HOLDING_SLACK_MPS
    })
}

/// Eqs. 13, 14: all half-planes by rank, the least yielding first, and the best velocity, m/s.
fn solve(world: &WorldView, agent: usize, set: VelocitySet, params: &McnParams, memory: &mut McnMemory) -> Vec2 {
    let forward = memory.forward;
    let (parts, constraints, factor) = (&params.parts, world.constraints_of(agent), world.speed_factor(agent));
    let allowed = constraints.set(set);
    let half_planes = &mut memory.programs[set as usize];
    half_planes.clear();
    half_planes.extend_from_slice(&memory.of_walls); // C_iW
    half_planes.extend(world.one_way_half_planes(agent));
    half_planes.extend(of_stance(world, agent, params)); // C_bm
    if parts.sharp_turns && set == VelocitySet::Turning {
        half_planes.extend(constraints.sharp_turn(forward, world.preferred_mps[agent], factor));
    }
    if parts.hull {
        half_planes.extend(allowed.half_planes(forward, factor, set.into())); // Eqs. 4, 5
    }
    let firm_count = half_planes.len();
    half_planes.extend_from_slice(&memory.of_agents); // C_ij
    let hurry_mps = (HURRY * world.preferred_mps[agent].length()).max(factor * BRISK_MPS);
    let speed_max_mps = hurry_mps.min(factor * allowed.speed_max_mps);
    linear_program::solve(half_planes, firm_count, memory.adapted_mps, speed_max_mps, &mut memory.projected)
        .velocity_mps
}

/// C_bm, in the form that the tunables choose.
fn of_stance(world: &WorldView, agent: usize, params: &McnParams) -> Option<HalfPlane> {
    let stance = &world.stances[agent];
    match params.parts.stance {
        StanceForm::Landing => stance_half_plane(stance, params.stance_twist_rad),
        StanceForm::Radial => {
            let own = world.disc(agent);
            let segment_m = radial_segment_m(stance, own.radius_m)?;
            segment_half_plane(segment_m, &own, params.obstacle_time_horizon_s, HalfPlaneSource::Stance)
        }
        StanceForm::Off => None,
    }
}

/// §4.5, given the velocity found so far.
fn orient(world: &WorldView, agent: usize, velocity_mps: Vec2, params: &McnParams, memory: &McnMemory) -> Orientation {
    let input = OrientationInput {
        forward: memory.forward,
        preferred_mps: world.along_route_mps(agent),
        velocity_mps,
        strafing_s: world.strafing_s[agent],
        stepping_back_s: world.stepping_back_s[agent],
    };
    if !params.parts.orientation {
        return orientation::along_the_velocity(&input);
    }
    // The paper has no stepping back: bodies that turn spanned its set.
    let (constraints, factor) = (world.constraints_of(agent), world.speed_factor(agent));
    let back_pedalling = params.parts.back_pedalling && constraints.construction != Construction::Paper;
    let may_hold = back_pedalling || input.preferred_mps.dot(velocity_mps) >= 0.0;
    let holding = constraints.set(VelocitySet::Holding);
    let holds =
        |facing| may_hold && holding.outside_mps(facing, factor, velocity_mps) <= orientation::HOLDING_SLACK_MPS;
    orientation::decide(&input, holds, world.dt_s, params)
}

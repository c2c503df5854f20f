//! MCN, motion-constrained navigation (`FbCrowd` §4): from the preferred velocity to one that body, stance and crowd
//! allow.
//!
//! One function, [`plan`], in the order of the paper: who and what is near; v_pref → v_op by social forces and density
//! filter (§4.3); the half-planes of walls, stance, database and other agents (§4.1, 4.2, 4.4); the linear programs
//! (App. 9.3, 9.4); the facing (§4.5).
//!
//! It reads a frozen [`World`] and writes nothing but its [`Scratch`], so agents may be planned in any order and on any
//! thread. World axes, metres, seconds, radians.

pub(crate) mod density;
pub(crate) mod keep_right;
pub(crate) mod motion_constraints;
pub(crate) mod orientation;
pub(crate) mod params;
pub(crate) mod social_force;
pub mod stance;
#[cfg(test)]
pub(crate) mod tests;

pub use density::Filtered;
pub use motion_constraints::{ConvexSet, MotionConstraints};
pub use orientation::{Orientation, Walk};
pub use params::{McnParams, Parts, StanceForm};
pub use social_force::PowerLaw;

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::Construction;

use crate::planning::orca::half_plane::{HalfPlane, Source};
use crate::planning::orca::{agents, linear_program, walls};
use crate::planning::plan::{Plan, VelocitySet};
use crate::planning::planner::{Scratch, look_around, time_to_collision_s};
use crate::planning::world_view::World;
use crate::world::neighbour_lanes::{Around, LANES, Lanes};
use crate::world::neighbours::Neighbour;

/// Greatest speed at which a wall is looked for ahead, m/s: a run.
const WALL_SPEED_MPS: f32 = 4.0;
/// From here on somebody counts as walking, m/s: a slow walk. Measured with people 0.8 m apart: at half of it one in
/// two hundred does not arrive.
const SLOW_WALK_MPS: f32 = 0.6;
/// Whoever may be met after this time counts half as much as who is touched, s: what a walker needs to react. Of 0.1,
/// 0.3 and 1 s, tried in the four-way crossing of Table 1 alone, A came to between 0.304 and 0.323 m/s².
const REACTION_S: f32 = 0.3;
/// Speed at which those who keep their distance might come, m/s.
const APPROACH_MPS: f32 = 1.0;
/// What a disc keeps from walls, m: a body's root leaves its plan by about a centimetre, and would touch a corner that
/// its disc grazes. With this, walls hold no disc in `fbcrowd bench course`.
const WALL_MARGIN_M: f32 = 0.012;

/// Plans one agent's next velocity and facing.
pub fn plan(world: &World, agent: usize, params: &McnParams, scratch: &mut Scratch) -> Plan {
    let wall_range_m = params.obstacle_time_horizon_s * WALL_SPEED_MPS;
    look_around(world, agent, params.neighbour_range_m, wall_range_m, scratch);
    let density = adapt(world, agent, params, scratch);
    avoid(world, agent, params, scratch);
    scratch.forward = world.forward(agent);
    let turning_mps = choose(world, agent, VelocitySet::Turning, params, scratch);
    // Who would stand though it could side-step does that: a narrow turning set leaves nothing before a wall, or
    // somebody, that the facing meets askew.
    let stands = orientation::stands(turning_mps) && !orientation::stands(scratch.adapted_mps);
    let holding_mps = stands.then(|| choose(world, agent, VelocitySet::Holding, params, scratch));
    let orientation = orient(world, agent, holding_mps.unwrap_or(turning_mps), params, scratch);
    scratch.set = orientation.set;
    let velocity_mps = match orientation.set {
        VelocitySet::Turning => turning_mps,
        VelocitySet::Holding => {
            holding_mps.unwrap_or_else(|| choose(world, agent, VelocitySet::Holding, params, scratch))
        }
    };
    Plan {
        velocity_mps,
        facing_rad: libm::atan2f(orientation.facing.y, orientation.facing.x),
        time_to_collision_s: time_to_collision_s(world, agent, scratch),
        density,
        set: orientation.set,
        strafing_s: orientation.strafing_s,
        stepping_back_s: orientation.stepping_back_s,
    }
}

/// §4.3: v_op into the scratch; returns the density met.
fn adapt(world: &World, agent: usize, params: &McnParams, scratch: &mut Scratch) -> f32 {
    let (velocity_mps, mut adapted_mps) = (world.velocities_mps[agent], world.preferred_mps[agent]);
    let lead_s = world.lead_s(params.response_s);
    if params.parts.keep_right {
        adapted_mps = keep_right::kept_right(adapted_mps, velocity_mps, scratch.nearest.around(), params);
    }
    if params.parts.adaptation {
        let forces_mps2 = forces_mps2(world, agent, params, scratch);
        adapted_mps = social_force::adapted_mps(velocity_mps, adapted_mps, forces_mps2, lead_s, params);
    }
    let filtered = density::filter(adapted_mps, velocity_mps, scratch.nearest.around(), lead_s, params);
    scratch.adapted_mps = if params.parts.density_filter { filtered.velocity_mps } else { adapted_mps };
    filtered.density
}

/// Σ f_ij + Σ f_iW.
fn forces_mps2(world: &World, agent: usize, params: &McnParams, scratch: &Scratch) -> Vec2 {
    let (own, law) = (world.disc(agent), params.power_law());
    let met = |neighbour: &&Neighbour| neighbour.time_to_collision_s.is_finite();
    let of_agents = scratch.nearest.as_slice().iter().filter(met).map(|neighbour| {
        social_force::agent_force_mps2(neighbour.offset_m, neighbour.velocity_mps, neighbour.radius_m, &law)
    });
    let of_walls = scratch.edges.iter().map(|near| {
        social_force::wall_force_mps2(world.edge_m(agent, near.edge), own.velocity_mps, own.radius_m, &law)
    });
    of_agents.chain(of_walls).sum()
}

/// Eq. 12: the half-planes of walls and agents.
fn avoid(world: &World, agent: usize, params: &McnParams, scratch: &mut Scratch) {
    let own = world.disc(agent);
    scratch.of_walls.clear();
    let (edges, horizon_s) = (&scratch.edges, params.obstacle_time_horizon_s);
    let wider = agents::Disc { radius_m: own.radius_m + WALL_MARGIN_M, ..own };
    walls::obstacle_half_planes(world.obstacles, edges, &wider, horizon_s, &mut scratch.of_walls);
    // What differs between neighbours is found for all of them at once.
    let around = scratch.nearest.around();
    let shares = if params.parts.keep_right { agents::shares(own.velocity_mps, around) } else { [agents::HALF; LANES] };
    let weights = if params.parts.order { urgencies(around) } else { [1.0; LANES] };
    let horizons_s = horizons_against_s(own.velocity_mps, around, params);
    scratch.of_agents.clear();
    scratch.of_agents.extend(scratch.nearest.as_slice().iter().enumerate().map(|(lane, neighbour)| {
        let (share, horizon_s) = (shares[lane], horizons_s[lane]);
        let half_plane = agents::agent_half_plane(own.velocity_mps, neighbour, share, horizon_s, world.dt_s);
        HalfPlane { weight: weights[lane], ..half_plane }
    }));
}

/// τ against each: whoever stands is a wall, and is avoided no earlier. With τ itself, nobody gets through the gaps
/// between those who stand at their goals: at rest each of them bounds the approach to gap/τ.
fn horizons_against_s(own_mps: Vec2, around: &Around, params: &McnParams) -> Lanes {
    std::array::from_fn(|lane| {
        let other_mps = own_mps - around.velocity_mps(lane);
        let walks = (other_mps.length_squared().sqrt() / SLOW_WALK_MPS).min(1.0);
        params.obstacle_time_horizon_s + walks * (params.time_horizon_s - params.obstacle_time_horizon_s)
    })
}

/// The order of yielding (App. 9.4): 1 for whoever is touched, less the later somebody may be met. Time to collision
/// itself jumps to infinity as soon as somebody is avoided; this is the time to touch whoever came straight on.
fn urgencies(around: &Around) -> Lanes {
    std::array::from_fn(|lane| {
        let offset_m = around.offset_m(lane);
        let distance_m = offset_m.length_squared().sqrt();
        let gap_m = (distance_m - around.radius_m[lane]).max(0.0);
        let closing = around.velocity_mps(lane).dot(offset_m) / distance_m.max(f32::MIN_POSITIVE);
        REACTION_S / (REACTION_S + gap_m / (closing.max(0.0) + APPROACH_MPS))
    })
}

/// Eqs. 13, 14: all half-planes by rank, what never yields first, and the best velocity.
fn choose(world: &World, agent: usize, set: VelocitySet, params: &McnParams, scratch: &mut Scratch) -> Vec2 {
    let forward = scratch.forward;
    let (parts, allowed) = (&params.parts, world.constraints.set(set));
    let half_planes = &mut scratch.half_planes[set as usize];
    half_planes.clear();
    half_planes.extend_from_slice(&scratch.of_walls);
    half_planes.extend(of_stance(world, agent, params));
    if parts.sharp_turns && set == VelocitySet::Turning {
        half_planes.extend(world.constraints.sharp_turn(forward, world.preferred_mps[agent]));
    }
    if parts.hull {
        half_planes.extend(allowed.half_planes(forward, set.into()));
    }
    let firm = half_planes.len();
    half_planes.extend_from_slice(&scratch.of_agents);
    linear_program::solve(half_planes, firm, scratch.adapted_mps, allowed.speed_max_mps, &mut scratch.projected)
        .velocity_mps
}

/// C_bm.
fn of_stance(world: &World, agent: usize, params: &McnParams) -> Option<HalfPlane> {
    let stance = &world.stances[agent];
    match params.parts.stance {
        StanceForm::Landing => stance::half_plane(stance, params.stance_twist_rad),
        StanceForm::Radial => {
            let own = world.disc(agent);
            let segment_m = stance::radial_segment_m(stance, own.radius_m)?;
            walls::segment_half_plane(segment_m, &own, params.obstacle_time_horizon_s, Source::Stance)
        }
        StanceForm::Off => None,
    }
}

/// §4.5, given the velocity that the turning set allows.
fn orient(world: &World, agent: usize, velocity_mps: Vec2, params: &McnParams, scratch: &Scratch) -> Orientation {
    let walk = Walk {
        forward: scratch.forward,
        preferred_mps: world.preferred_mps[agent],
        velocity_mps,
        strafing_s: world.strafing_s[agent],
        stepping_back_s: world.stepping_back_s[agent],
    };
    if !params.parts.orientation {
        return orientation::along_the_velocity(&walk);
    }
    // The paper knows no stepping back: its set was spanned by bodies that turn.
    let back_pedalling = params.parts.back_pedalling && world.constraints.construction != Construction::Paper;
    let may_hold = back_pedalling || walk.preferred_mps.dot(velocity_mps) >= 0.0;
    let held = world.constraints.set(VelocitySet::Holding);
    let holds = |facing| may_hold && held.outside_mps(facing, velocity_mps) <= orientation::HOLDING_SLACK_MPS;
    orientation::decide(&walk, holds, world.dt_s, params)
}

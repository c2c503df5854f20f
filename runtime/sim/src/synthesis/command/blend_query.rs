//! From a plan to the parameters asked of the blend space: (v, o_d) → (v_f, ω_t, ω_s) → shares (`FbCrowd` §5, "query
//! point").
//!
//! With α the angle from the facing to the wanted one, and (a, b) the planned velocity along and left of the *wanted*
//! facing,
//!
//! ```text
//! ω_t = α / T_turn,   (v_f, ω_s) = (a, b)·max(0, cos α)
//! ```
//!
//! A plan whose facing follows its velocity has b = 0 and becomes a turning clip, at the speed that brings the body
//! where the plan wants it (going on at full speed while it faces elsewhere leads away); one that holds the facing has
//! α = 0 and becomes a side-step or a step back. To ask for the planned velocity exactly while turning, side-stepping
//! a·sin α, is worse in every way: it lies so far outside the examples that the nearest point of their hull hardly
//! turns. The root then moves from what it does towards what is asked at limited accelerations, straight through the
//! space of parameters: the body passes the examples between.

use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::Parameters;

use crate::maths::angle::{direction, wrap_rad};
use crate::planning::plan::Plan;
use crate::synthesis::blending::blend_space::Space;
use crate::synthesis::params::HmsParams;
use crate::synthesis::semi_procedural::base_walk::SemiProcedural;

/// What a plan asks of a body that faces `facing_rad`; anything not finite asks to stand.
pub(crate) fn asked(plan: &Plan, facing_rad: f32, space: &Space, params: &HmsParams) -> Parameters {
    if !(plan.velocity_mps.is_finite() && plan.facing_rad.is_finite()) {
        return Parameters::default();
    }
    let turn_rad = wrap_rad(plan.facing_rad - facing_rad);
    let velocity_mps = plan.velocity_mps * direction(turn_rad).x.max(0.0);
    let wanted_mps = direction(-plan.facing_rad).rotate(velocity_mps.clamp_length_max(space.speed_max_mps));
    let turn_rate_rad_s = (turn_rad / params.turn_time_s).clamp(-space.turn_rate_max_rad_s, space.turn_rate_max_rad_s);
    // Who has no side-steps is asked for none: the nearest to them that turning clips have leads elsewhere.
    let [right_mps, left_mps] = space.strafe_mps;
    Parameters { speed_mps: wanted_mps.x, turn_rate_rad_s, strafe_mps: wanted_mps.y.clamp(right_mps, left_mps) }
}

/// The plan by which a blending body at `root` is asked for exactly these parameters: the inverse of `asked`.
pub fn asking(asked: Parameters, root: &Root, params: &HmsParams) -> Plan {
    let lead_rad = asked.turn_rate_rad_s * params.turn_time_s;
    let facing_rad = root.facing_rad + lead_rad;
    let velocity_mps = Vec2::new(asked.speed_mps, asked.strafe_mps) / lead_rad.cos();
    Plan {
        velocity_mps: Vec2::from_angle(facing_rad).rotate(velocity_mps),
        facing_rad,
        time_to_collision_s: f32::INFINITY,
        ..Plan::default()
    }
}

/// What a plan asks of semi-procedural locomotion, which can do it: the planned velocity itself, whatever the facing.
/// The body turns by `turning_rad` meanwhile, and its way lies along the facing at half of that.
pub(crate) fn asked_exactly(
    plan: &Plan,
    facing_rad: f32,
    turning_rad: f32,
    semi_procedural: &SemiProcedural,
    params: &HmsParams,
) -> Parameters {
    if !(plan.velocity_mps.is_finite() && plan.facing_rad.is_finite()) {
        return Parameters::default();
    }
    let local_mps = direction(-facing_rad - 0.5 * turning_rad).rotate(plan.velocity_mps);
    let turn_rate_rad_s = wrap_rad(plan.facing_rad - facing_rad) / params.turn_time_s;
    semi_procedural.reachable(Parameters { speed_mps: local_mps.x, turn_rate_rad_s, strafe_mps: local_mps.y })
}

/// The point on the straight way from `now` to `goal` that a body may reach in one step.
pub(crate) fn step_towards(now: Parameters, goal: Parameters, params: &HmsParams, dt_s: f32) -> Parameters {
    let [of_velocity, of_turn] = fractions(now, goal, params, dt_s);
    let fraction = of_velocity.min(of_turn);
    if fraction == 1.0 {
        return goal; // without rounding: what lies there is known already
    }
    Parameters::from_vec3(now.to_vec3() + fraction * (goal.to_vec3() - now.to_vec3()))
}

/// The same, turning and walking each as far as it may: m_sp knows no examples between.
pub(crate) fn step_apart(now: Parameters, goal: Parameters, params: &HmsParams, dt_s: f32) -> Parameters {
    let [of_velocity, of_turn] = fractions(now, goal, params, dt_s);
    let change = goal.to_vec3() - now.to_vec3();
    Parameters::from_vec3(now.to_vec3() + Vec3::new(of_velocity, of_turn, of_velocity) * change)
}

/// How much of a change of velocity, and of one of turn rate, a body may make in one step.
fn fractions(now: Parameters, goal: Parameters, params: &HmsParams, dt_s: f32) -> [f32; 2] {
    let change = goal.to_vec3() - now.to_vec3();
    let within = |change: f32, change_max: f32| if change <= change_max { 1.0 } else { change_max / change };
    [
        within(Vec2::new(change.x, change.z).length(), params.acceleration_max_mps2 * dt_s),
        within(change.y.abs(), params.turn_acceleration_max_rad_s2 * dt_s),
    ]
}

//! Query point: from a plan (v, o_d) to the parameters (v_f, ω_t, ω_s) that it requests of a body (`FbCrowd` §5).
//!
//! α is the angle from the facing to the planned one, (a, b) the planned velocity along and left of the *planned*
//! facing. A body that blends is requested
//!
//! ```text
//! ω_t = α / T_turn,   (v_f, ω_s) = (a, b)·max(0, cos α).
//! ```
//!
//! A plan whose facing follows its velocity has b = 0 and requests a turning example, at the speed that brings the body
//! where the plan leads; at full speed a body that faces elsewhere would leave the path. A plan that holds the facing
//! has α = 0 and requests a side-step or a step back. The exact planned velocity has a side-step during a turn,
//! a·sin α. It lies so far outside the examples that the nearest point of their hull hardly turns; m_sp can follow it.
//!
//! Plans are in the world, parameters in the body's frame (x forward, y left); m/s, radians, rad/s.

use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::Parameters;

use crate::maths::angle::{unit_vector, wrap_rad};
use crate::planning::plan::Plan;
use crate::synthesis::HmsParams;
use crate::synthesis::blending::BlendDomain;
use crate::synthesis::semi_procedural::BaseWalk;

/// Parameters requested of a blending body that faces `facing_rad`; (0, 0, 0) where the plan is not finite.
pub(crate) fn requested_of_blending(
    plan: &Plan,
    facing_rad: f32,
    domain: &BlendDomain,
    params: &HmsParams,
) -> Parameters {
    if !is_finite(plan) {
        return Parameters::default();
    }
    let turn_rad = wrap_rad(plan.facing_rad - facing_rad);
    let velocity_mps = plan.velocity_mps * unit_vector(turn_rad).x.max(0.0);
    let local_mps = unit_vector(-plan.facing_rad).rotate(velocity_mps.clamp_length_max(domain.speed_max_mps));
    let turn_rate_rad_s =
        (turn_rad / params.turn_time_s).clamp(-domain.turn_rate_max_rad_s, domain.turn_rate_max_rad_s);
    // Without side-steps in the database, turning examples would be nearest, which lead elsewhere.
    let [right_mps, left_mps] = domain.strafe_range_mps;
    Parameters { speed_mps: local_mps.x, turn_rate_rad_s, strafe_mps: local_mps.y.clamp(right_mps, left_mps) }
}

/// Parameters requested of a body in semi-procedural locomotion that faces `facing_rad`: the planned velocity itself.
/// The body turns by `turning_rad` during the step, and its chord lies at half of that.
pub(crate) fn requested_of_base_walk(
    plan: &Plan,
    facing_rad: f32,
    turning_rad: f32,
    base_walk: &BaseWalk,
    params: &HmsParams,
) -> Parameters {
    if !is_finite(plan) {
        return Parameters::default();
    }
    let local_mps = unit_vector(-facing_rad - 0.5 * turning_rad).rotate(plan.velocity_mps);
    let turn_rate_rad_s = wrap_rad(plan.facing_rad - facing_rad) / params.turn_time_s;
    base_walk.reachable(Parameters { speed_mps: local_mps.x, turn_rate_rad_s, strafe_mps: local_mps.y })
}

/// The plan that requests exactly these parameters of a blending body at `root`: the inverse of the query.
pub fn plan_requesting(requested: Parameters, root: &Root, params: &HmsParams) -> Plan {
    let turn_rad = requested.turn_rate_rad_s * params.turn_time_s;
    let facing_rad = root.facing_rad + turn_rad;
    let velocity_mps = requested.velocity_mps() / libm::cosf(turn_rad);
    Plan {
        velocity_mps: Vec2::from_angle(facing_rad).rotate(velocity_mps),
        facing_rad,
        time_to_collision_s: f32::INFINITY,
        ..Plan::default()
    }
}

fn is_finite(plan: &Plan) -> bool {
    plan.velocity_mps.is_finite() && plan.facing_rad.is_finite()
}

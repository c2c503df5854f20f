//! Limits on how fast the parameters of a body change: the acceleration of its root and of its turn rate.
//!
//! Parameters (v_f, ω_t, ω_s), m/s and rad/s; accelerations m/s² and rad/s².

use glam::{Vec2, Vec3};
use motiondb::motion::Parameters;

use crate::synthesis::HmsParams;

/// The point on the straight line from `current` to `target` that a blending body reaches in one step: it passes the
/// examples between.
pub(crate) fn limited_along_line(current: Parameters, target: Parameters, params: &HmsParams, dt_s: f32) -> Parameters {
    let [of_velocity, of_turn_rate] = fractions(current, target, params, dt_s);
    let fraction = of_velocity.min(of_turn_rate);
    if fraction == 1.0 {
        return target; // exactly: what the examples reach there may be known
    }
    Parameters::from_vec3(current.to_vec3() + fraction * (target.to_vec3() - current.to_vec3()))
}

/// The point that m_sp reaches in one step: velocity and turn rate change independently, since there are no examples to
/// pass.
pub(crate) fn limited_by_axis(current: Parameters, target: Parameters, params: &HmsParams, dt_s: f32) -> Parameters {
    let [of_velocity, of_turn_rate] = fractions(current, target, params, dt_s);
    let change = target.to_vec3() - current.to_vec3();
    Parameters::from_vec3(current.to_vec3() + Vec3::new(of_velocity, of_turn_rate, of_velocity) * change)
}

/// Fractions of the changes of velocity and of turn rate that the limits allow in one step.
fn fractions(current: Parameters, target: Parameters, params: &HmsParams, dt_s: f32) -> [f32; 2] {
    let change = target.to_vec3() - current.to_vec3();
    let within = |change: f32, change_max: f32| if change <= change_max { 1.0 } else { change_max / change };
    [
        within(Vec2::new(change.x, change.z).length(), params.acceleration_max_mps2 * dt_s),
        within(change.y.abs(), params.turn_acceleration_max_rad_s2 * dt_s),
    ]
}

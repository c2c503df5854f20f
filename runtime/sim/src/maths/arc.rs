//! The arc along which a root moves at constant (v_f, ω_t, ω_s), and its inverse. The chord of the arc lies at half the
//! turn, so a step is exact.
//!
//! World frame of roots, or root frame (x forward, y left); metres, seconds, radians.

use glam::Vec2;
use motiondb::body::{Root, RootFrame};
use motiondb::motion::Parameters;

use crate::maths::angle::{unit_vector, wrap_rad};

/// The root after a step at constant parameters.
pub fn moved_root(root: &Root, parameters: &Parameters, dt_s: f32) -> Root {
    let half_turn_rad = 0.5 * dt_s * parameters.turn_rate_rad_s;
    let chord_m = chord_m(parameters, dt_s, half_turn_rad);
    Root {
        position_m: root.position_m + unit_vector(root.facing_rad + half_turn_rad).rotate(chord_m),
        facing_rad: wrap_rad(root.facing_rad + 2.0 * half_turn_rad),
    }
}

/// The frame, in the root frame at the start, of a root that has moved for `time_s`; and the unit vector at half the
/// turn.
pub(crate) fn arc_frame(parameters: &Parameters, time_s: f32) -> (RootFrame, Vec2) {
    let half_turn_rad = 0.5 * time_s * parameters.turn_rate_rad_s;
    let half_turn = unit_vector(half_turn_rad);
    let chord_m = chord_m(parameters, time_s, half_turn_rad);
    (RootFrame { position_m: half_turn.rotate(chord_m), forward: half_turn.rotate(half_turn) }, half_turn)
}

/// The parameters whose arc leads from one root to another in a step: the inverse of [`moved_root`].
pub fn parameters_between(from: &Root, to: &Root, dt_s: f32) -> Parameters {
    let half_turn_rad = 0.5 * wrap_rad(to.facing_rad - from.facing_rad);
    let local_m = Vec2::from_angle(-from.facing_rad - half_turn_rad).rotate(to.position_m - from.position_m);
    let local_mps = local_m / (dt_s * chord_over_arc(half_turn_rad));
    Parameters { speed_mps: local_mps.x, turn_rate_rad_s: 2.0 * half_turn_rad / dt_s, strafe_mps: local_mps.y }
}

/// Displacement along an arc, in the frame at half the turn, m.
#[inline]
fn chord_m(parameters: &Parameters, time_s: f32, half_turn_rad: f32) -> Vec2 {
    parameters.velocity_mps() * time_s * chord_over_arc(half_turn_rad)
}

/// Length of the chord, divided by that of the arc.
#[inline]
fn chord_over_arc(half_turn_rad: f32) -> f32 {
    if half_turn_rad.abs() > 1e-3 { unit_vector(half_turn_rad).y / half_turn_rad } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn parameters_between_roots_invert_a_move() {
        let (from, dt_s) = (Root { position_m: Vec2::new(3.0, -1.0), facing_rad: 3.0 }, 1.0 / 30.0);
        for parameters in [Vec3::new(1.2, 1.5, -0.3), Vec3::new(-0.5, 0.0, 0.2)].map(Parameters::from_vec3) {
            let found = parameters_between(&from, &moved_root(&from, &parameters, dt_s), dt_s);
            assert!(found.to_vec3().distance(parameters.to_vec3()) < 1e-4, "{found:?}");
        }
    }
}

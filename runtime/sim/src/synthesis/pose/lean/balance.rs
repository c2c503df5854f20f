//! The lean in which a body that accelerates is in balance: the line from its feet to its centre of mass points along
//! gravity and inertia, so it leans by atan(a/g) in the direction of the acceleration a.
//!
//! In a steady motion with velocity v and turn rate ω_t, a = ω_t × v: nothing on the spot and straight on, and across
//! the travel in a curve. In captured circles the line from ankles to pelvis leans so (`docs/tuning.md`).
//!
//! Root frame (x forward, y left); m/s², radians. A lean is a vector: its direction, and its angle as its length.

use glam::Vec2;
use motiondb::motion::Parameters;

/// Gravity g, m/s².
const GRAVITY_MPS2: f32 = 9.81;

/// Greatest square of a/g for six terms of Taylor's series of the arc tangent, to 2e−5 of its value.
const SMALL_SQUARE: f32 = 0.25;

/// The lean of a body that accelerates, rad.
pub(crate) fn balanced_lean_rad(acceleration_mps2: Vec2) -> Vec2 {
    let tangent = acceleration_mps2 * (1.0 / GRAVITY_MPS2);
    let square = tangent.length_squared();
    if square > SMALL_SQUARE {
        let size = tangent.length();
        return libm::atanf(size) / size * tangent;
    }
    let terms = [-1.0 / 11.0, 1.0 / 9.0, -1.0 / 7.0, 0.2, -1.0 / 3.0, 1.0];
    terms.into_iter().fold(0.0, |sum, term| sum * square + term) * tangent
}

/// The lean of a body in a steady motion, rad.
pub(crate) fn lean_in_curve_rad(parameters: &Parameters) -> Vec2 {
    balanced_lean_rad(parameters.turn_rate_rad_s * parameters.velocity_mps().perp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lean at a speed forward and a turn rate, degrees.
    fn lean_deg(speed_mps: f32, turn_rate_deg_s: f32) -> Vec2 {
        let turn_rate_rad_s = turn_rate_deg_s.to_radians();
        lean_in_curve_rad(&Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 }) * 1_f32.to_degrees()
    }

    #[test]
    fn leans_are_arc_tangents() {
        for step in 0..2_000 {
            let size_mps2 = 0.01 * step as f32;
            let lean_rad = balanced_lean_rad(size_mps2 * Vec2::from_angle(2.0)).length();
            assert!((lean_rad - libm::atanf(size_mps2 / GRAVITY_MPS2)).abs() < 1e-5, "{size_mps2}");
        }
    }

    #[test]
    fn bodies_lean_into_curves_alone() {
        assert!(lean_deg(1.4, 87.0).distance(Vec2::new(0.0, 12.2)) < 0.1);
        assert!(lean_deg(1.4, -87.0).distance(Vec2::new(0.0, -12.2)) < 0.1);
        assert_eq!([lean_deg(1.4, 0.0), lean_deg(0.0, 170.0)], [Vec2::ZERO; 2]);
    }

    #[test]
    fn side_steps_lean_across_their_travel() {
        let left = Parameters { speed_mps: 0.0, turn_rate_rad_s: 1.0, strafe_mps: 0.6 };
        let lean_rad = lean_in_curve_rad(&left);
        assert!(lean_rad.x < -0.06 && lean_rad.y.abs() < 1e-6, "{lean_rad}");
    }
}

//! Angles, radians.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2};

/// Where five terms of Taylor's series suffice.
const SMALL_RAD: f32 = 1.0;

/// The same angle in [−π, π].
pub fn wrap_rad(angle_rad: f32) -> f32 {
    (angle_rad - TAU * libm::roundf(angle_rad / TAU)).clamp(-PI, PI)
}

/// The unit vector at an angle. Most angles are small: for them Taylor's series, to rounding, without a call.
#[inline]
pub fn direction(angle_rad: f32) -> Vec2 {
    if angle_rad.abs() > SMALL_RAD {
        return Vec2::from_angle(angle_rad);
    }
    let square = angle_rad * angle_rad;
    let series = |terms: [f32; 5]| terms.into_iter().rev().fold(0.0, |sum, term| sum * square + term);
    let sine = angle_rad * series([1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0]);
    let cosine = 1.0 - square * series([0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0]);
    Vec2::new(cosine, sine)
}

/// A rotation about the vertical.
#[inline]
pub fn yaw(angle_rad: f32) -> Quat {
    let half = direction(0.5 * angle_rad);
    Quat::from_xyzw(0.0, 0.0, half.y, half.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_sine_and_cosine_to_rounding() {
        for step in -4000..=4000 {
            let angle_rad = step as f32 * 1e-3;
            let (sine, cosine) = f64::from(angle_rad).sin_cos();
            let found = direction(angle_rad);
            assert!(
                (f64::from(found.y) - sine).abs() < 1e-7 && (f64::from(found.x) - cosine).abs() < 1e-7,
                "{angle_rad}"
            );
        }
        assert!(!direction(f32::NAN).is_finite() && !direction(f32::INFINITY).is_finite());
    }
}

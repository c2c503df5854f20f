//! Angles: wrapping, unit vectors and rotations. Small angles, which are most, need no library call.
//!
//! Radians, counter-clockwise.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3};

/// Greatest angle, and square of an angle, for five terms of Taylor's series, rad and rad².
const SMALL: f32 = 1.0;

/// The same angle in [−π, π].
#[inline]
pub fn wrap_rad(angle_rad: f32) -> f32 {
    if angle_rad.abs() < PI {
        return angle_rad;
    }
    (angle_rad - TAU * libm::roundf(angle_rad / TAU)).clamp(-PI, PI)
}

/// The unit vector at an angle, to rounding.
#[inline]
pub(crate) fn unit_vector(angle_rad: f32) -> Vec2 {
    if angle_rad.abs() > SMALL {
        return Vec2::from_angle(angle_rad);
    }
    let (sine_share, cosine) = series(angle_rad * angle_rad);
    Vec2::new(cosine, angle_rad * sine_share)
}

/// The angle from one vector to another, rad; 0 if either is zero.
#[inline]
pub(crate) fn angle_between_rad(from: Vec2, to: Vec2) -> f32 {
    let (across, along) = (from.perp_dot(to), from.dot(to));
    if across.abs() > 0.25 * along {
        return libm::atan2f(across, along);
    }
    let tangent = if along > 0.0 { across / along } else { 0.0 };
    let square = tangent * tangent;
    let terms = [1.0 / 9.0, -1.0 / 7.0, 0.2, -1.0 / 3.0, 1.0];
    tangent * terms.into_iter().fold(0.0, |sum, term| sum * square + term)
}

/// The rotation about the vertical by an angle.
#[inline]
pub(crate) fn yaw(angle_rad: f32) -> Quat {
    let half = unit_vector(0.5 * angle_rad);
    Quat::from_xyzw(0.0, 0.0, half.y, half.x)
}

/// The rotation by a rotation vector, axis × angle, rad.
#[inline]
pub(crate) fn rotation(vector_rad: Vec3) -> Quat {
    let square = 0.25 * vector_rad.length_squared();
    if square > SMALL {
        return Quat::from_scaled_axis(vector_rad);
    }
    let (sine_share, cosine) = series(square);
    let half = 0.5 * sine_share * vector_rad;
    Quat::from_xyzw(half.x, half.y, half.z, cosine)
}

/// Sine over angle, and cosine, of a small angle whose square is given.
#[inline]
fn series(square: f32) -> (f32, f32) {
    let sum = |terms: [f32; 5]| terms.into_iter().rev().fold(0.0, |sum, term| sum * square + term);
    let sine_share = sum([1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0]);
    let cosine = 1.0 - square * sum([0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40_320.0, 1.0 / 3_628_800.0]);
    (sine_share, cosine)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn unit_vectors_are_cosine_and_sine_to_rounding() {
        for step in -40_000..=40_000 {
            let angle_rad = step as f32 * 1e-3;
            let (sine, cosine) = libm::sincos(f64::from(angle_rad));
            let found = unit_vector(angle_rad);
            assert!(
                (f64::from(found.y) - sine).abs() < 1e-7 && (f64::from(found.x) - cosine).abs() < 1e-7,
                "{angle_rad}"
            );
        }
        assert!(unit_vector(1e9).is_normalized());
        assert!(!unit_vector(f32::NAN).is_finite() && !unit_vector(f32::INFINITY).is_finite());
    }

    #[test]
    fn angles_between_vectors_are_found_in_the_whole_circle() {
        for step in -3_141..=3_141 {
            let (from, angle_rad) = (unit_vector(2.0), step as f32 * 1e-3);
            let found_rad = angle_between_rad(3.0 * from, 0.2 * unit_vector(2.0 + angle_rad));
            assert!((found_rad - angle_rad).abs() < 1e-6, "{angle_rad}");
        }
        assert_eq!(angle_between_rad(Vec2::ZERO, Vec2::X), 0.0);
    }

    proptest! {
        #[test]
        fn rotations_match_their_rotation_vectors(x in -2.0f32..2.0, y in -2.0f32..2.0, z in -2.0f32..2.0) {
            let vector_rad = Vec3::new(x, y, z);
            let (found, expected) = (rotation(vector_rad), Quat::from_scaled_axis(vector_rad));
            prop_assert!((found - expected).length() < 3e-7, "{found} {expected}");
        }
    }
}

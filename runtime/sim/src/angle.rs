//! Angles, radians.

use std::f32::consts::{PI, TAU};

/// The same angle in [−π, π].
pub fn wrap_rad(angle_rad: f32) -> f32 {
    (angle_rad - TAU * libm::roundf(angle_rad / TAU)).clamp(-PI, PI)
}

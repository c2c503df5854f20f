//! How far a joint may turn about the vertical. Radians.

use std::f32::consts::PI;

use glam::Quat;

/// The part of a turn that the limits of a joint allow, rad. A pose beyond a limit turns no further.
pub(crate) fn within_limits_rad(turn_rad: f32, rotation: Quat, [least_rad, greatest_rad]: [f32; 2]) -> f32 {
    // An arc is at most π/2 times its sine, so |yaw| ≤ π·|z|: usually far from the limits.
    if PI * rotation.z.abs() + turn_rad.abs() <= greatest_rad.min(-least_rad) {
        return turn_rad;
    }
    let yaw_rad = yaw_rad(rotation);
    (yaw_rad + turn_rad).clamp(least_rad.min(yaw_rad), greatest_rad.max(yaw_rad)) - yaw_rad
}

/// The vertical component of a rotation vector, which joint limits refer to, rad.
pub(crate) fn yaw_rad(rotation: Quat) -> f32 {
    if rotation.w < 0.0 { -rotation } else { rotation }.to_scaled_axis().z
}

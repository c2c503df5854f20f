//! Rotations about the body's axes, and the wave of a cycle.
//!
//! Frame: x forward, y left, z up, right-handed. A positive turn about y pitches forward (z towards x), about z yaws
//! left, about x raises the left side. Trigonometry goes through `libm`, so that the clips are the same bytes on every
//! machine.

use glam::{DQuat, DVec3};

/// A turn about x (forward): raises the left side, radians.
pub(crate) fn about_x(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// A turn about y (left): pitches forward, radians.
pub(crate) fn about_y(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// A turn about z (up): yaws to the left, radians.
pub(crate) fn about_z(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}

/// The rotation whose images of y and z are `left` and nearly `up`; both of unit length.
pub(crate) fn from_left_and_up(left: DVec3, up: DVec3) -> DQuat {
    let forward = left.cross(up).normalize();
    let matrix = glam::DMat3::from_cols(forward, left, forward.cross(left));
    DQuat::from_mat3(&matrix)
}

/// The share of a rotation along its shortest arc.
pub(crate) fn share_of(rotation: DQuat, share: f64) -> DQuat {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    DQuat::IDENTITY.slerp(rotation, share)
}

/// cos 2πp.
pub(crate) fn wave(p: f64) -> f64 {
    libm::cos(std::f64::consts::TAU * p)
}

/// p − ⌊p⌋.
pub(crate) fn wrapped(p: f64) -> f64 {
    p - libm::floor(p)
}

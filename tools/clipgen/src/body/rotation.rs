//! Rotations about the body's axes, and the wave of a cycle.
//!
//! Frame: x forward, y left, z up, right-handed; radians. A positive turn about y pitches forward (z towards x), about
//! z yaws left, about x raises the left side. Trigonometry goes through `libm`, so that the clips have the same bytes
//! on every machine.

use glam::{DQuat, DVec3};

/// A turn about x (forward); positive raises the left side.
pub(crate) fn about_x(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// A turn about y (left); positive pitches forward.
pub(crate) fn about_y(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// A turn about z (up); positive yaws to the left.
pub(crate) fn about_z(angle_rad: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}

/// The rotation that takes y to `left` and z nearly to `up`; both are unit vectors.
pub(crate) fn from_left_and_up(left: DVec3, up: DVec3) -> DQuat {
    let forward = left.cross(up).normalize();
    let matrix = glam::DMat3::from_cols(forward, left, forward.cross(left));
    DQuat::from_mat3(&matrix)
}

/// A share (0 to 1) of a rotation along its shorter arc.
pub(crate) fn share_of(rotation: DQuat, share: f64) -> DQuat {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    DQuat::IDENTITY.slerp(rotation, share)
}

/// cos 2πp of a phase p.
pub(crate) fn wave(p: f64) -> f64 {
    libm::cos(std::f64::consts::TAU * p)
}

/// A phase p in [0, 1): p − ⌊p⌋.
pub(crate) fn wrapped(p: f64) -> f64 {
    p - libm::floor(p)
}

//! Angles of trunk and arms, by the positions of the joints of a body's roles. Up is z; any unit of length; degrees.

use glam::DVec3;
use motiondb::body::Joint;

use crate::rig::roles::ARMS;

/// Greatest flexion of the elbow of a straight arm, degrees.
const STRAIGHT_DEG: f64 = 25.0;

/// Angle of the trunk, from pelvis to neck, off the vertical, degrees.
pub(crate) fn trunk_lean_deg(position: impl Fn(Joint) -> DVec3) -> f64 {
    angle_deg(position(Joint::Neck) - position(Joint::Pelvis), DVec3::Z)
}

/// Angle of the wrist of each arm off straight down, seen from its shoulder, degrees; `[left, right]`.
pub(crate) fn arms_deg(position: impl Fn(Joint) -> DVec3) -> [f64; 2] {
    ARMS.map(|[shoulder, _, wrist]| angle_deg(position(wrist) - position(shoulder), DVec3::NEG_Z))
}

/// The lesser angle of the two arms from straight down, degrees; 0 unless both are straight and point aside.
pub(crate) fn arms_out_deg(position: impl Fn(Joint) -> DVec3) -> f64 {
    let [left, right] = ARMS.map(|[shoulder, _, _]| position(shoulder));
    let to_left = (left - right).with_z(0.0).normalize_or_zero();
    let out_deg = |[shoulder, elbow, wrist]: [Joint; 3], outward: DVec3| {
        let [upper, fore] = [[shoulder, elbow], [elbow, wrist]].map(|[from, to]| position(to) - position(from));
        let arm = upper + fore;
        let (aside, ahead) = (arm.dot(outward), arm.dot(DVec3::Z.cross(outward)));
        let is_straight = angle_deg(upper, fore) < STRAIGHT_DEG && ahead.abs() < aside;
        if is_straight { libm::atan2(aside, -arm.z).to_degrees().max(0.0) } else { 0.0 }
    };
    out_deg(ARMS[0], to_left).min(out_deg(ARMS[1], -to_left))
}

/// Angle between two vectors, degrees.
fn angle_deg(a: DVec3, b: DVec3) -> f64 {
    libm::acos(a.normalize_or_zero().dot(b.normalize_or_zero()).clamp(-1.0, 1.0)).to_degrees()
}

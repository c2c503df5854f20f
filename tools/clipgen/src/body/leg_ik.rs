//! Legs by analytic two-bone inverse kinematics, from the bare bones of the skeleton.
//!
//! The knee lies in the plane of hip, ankle and the leg's forward direction (law of cosines). Unlike the compiler's
//! solver, which keeps the hinge axis and the foot of a recorded pose, there is no pose to start from. Hip and ankle
//! enter in any one frame (z up, metres); orientations leave in the same frame, against the rest pose.

use glam::{DQuat, DVec3};

use crate::body::rotation::from_left_and_up;
use crate::body::skeleton::{SHANK_M, THIGH_M};

/// Least flexion of a knee, rad: human knees do not straighten more in walking, and at 0 the bend has no direction.
const LEAST_KNEE_RAD: f64 = 2.5 * std::f64::consts::PI / 180.0;

/// Orientations of thigh and shank against the rest pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LegOrientations {
    /// Orientation of the thigh.
    pub(crate) thigh: DQuat,
    /// Orientation of the shank.
    pub(crate) shank: DQuat,
}

/// Greatest distance of the ankle from the hip, m.
fn longest_reach_m() -> f64 {
    reach_m(LEAST_KNEE_RAD)
}

/// Distance of hip and ankle at a flexion of the knee, m.
pub(crate) fn reach_m(knee_rad: f64) -> f64 {
    libm::sqrt(THIGH_M * THIGH_M + SHANK_M * SHANK_M + 2.0 * THIGH_M * SHANK_M * libm::cos(knee_rad))
}

/// The leg whose ankle is at a point, or as near as it reaches; the knee bends towards `forward_yaw_rad`.
pub(crate) fn leg_to_ankle(hip_m: DVec3, ankle_m: DVec3, forward_yaw_rad: f64) -> LegOrientations {
    let (sin, cos) = libm::sincos(forward_yaw_rad);
    let span = ankle_m - hip_m;
    let reach_m = span.length().min(longest_reach_m());
    let down = span.normalize();
    let forward = down.cross(DVec3::new(-sin, cos, 0.0)).normalize();
    let left = forward.cross(down);
    let bend_cos = (THIGH_M * THIGH_M + reach_m * reach_m - SHANK_M * SHANK_M) / (2.0 * THIGH_M * reach_m);
    let bend_cos = bend_cos.clamp(-1.0, 1.0);
    let thigh = down * bend_cos + forward * libm::sqrt(1.0 - bend_cos * bend_cos);
    let shank = (down * reach_m - thigh * THIGH_M) / SHANK_M;
    LegOrientations { thigh: from_left_and_up(left, -thigh), shank: from_left_and_up(left, -shank.normalize()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ankle_arrives_at_its_target() {
        let hip_m = DVec3::new(0.01, 0.09, 0.9);
        for ankle_m in [DVec3::new(0.3, 0.05, 0.1), DVec3::new(-0.4, 0.1, 0.25), DVec3::new(0.0, 0.3, 0.12)] {
            let leg = leg_to_ankle(hip_m, ankle_m, 0.2);
            let down = DVec3::NEG_Z;
            let found_m = hip_m + leg.thigh * (down * THIGH_M) + leg.shank * (down * SHANK_M);
            assert!(found_m.distance(ankle_m) < 1e-9, "{found_m} {ankle_m}");
        }
    }
}

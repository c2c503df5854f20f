//! Legs by analytic two-bone inverse kinematics, the knee in the plane of hip, ankle and the leg's own forward
//! direction.

use glam::{DQuat, DVec3};

use crate::body::{SHANK_M, THIGH_M};
use crate::rotation::from_left_and_up;

/// A knee never straightens beyond this flexion, radians: people's do not in walking, and at 0 the solution has no bend
/// to follow.
const LEAST_KNEE_RAD: f64 = 2.5 * std::f64::consts::PI / 180.0;

/// Thigh and shank in the frame in which hip and ankle were given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg {
    /// Orientation against the rest pose.
    pub(crate) thigh: DQuat,
    /// Orientation against the rest pose.
    pub(crate) shank: DQuat,
}

/// The farthest that the ankle may be from the hip, m.
pub(crate) fn longest_reach_m() -> f64 {
    reach_m(LEAST_KNEE_RAD)
}

/// Distance of hip and ankle at a knee flexion, m.
pub(crate) fn reach_m(knee_rad: f64) -> f64 {
    libm::sqrt(THIGH_M * THIGH_M + SHANK_M * SHANK_M + 2.0 * THIGH_M * SHANK_M * libm::cos(knee_rad))
}

/// Solves a leg; the knee bends towards `forward_yaw_rad`. An ankle out of reach is drawn towards the hip.
pub(crate) fn solve(hip_m: DVec3, ankle_m: DVec3, forward_yaw_rad: f64) -> Leg {
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
    Leg { thigh: from_left_and_up(left, -thigh), shank: from_left_and_up(left, -shank.normalize()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ankle_arrives_where_it_was_asked_for() {
        let hip_m = DVec3::new(0.01, 0.09, 0.9);
        for ankle_m in [DVec3::new(0.3, 0.05, 0.1), DVec3::new(-0.4, 0.1, 0.25), DVec3::new(0.0, 0.3, 0.12)] {
            let leg = solve(hip_m, ankle_m, 0.2);
            let down = DVec3::NEG_Z;
            let found_m = hip_m + leg.thigh * (down * THIGH_M) + leg.shank * (down * SHANK_M);
            assert!(found_m.distance(ankle_m) < 1e-9, "{found_m} {ankle_m}");
        }
    }
}

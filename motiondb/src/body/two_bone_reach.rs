//! Two-bone inverse kinematics: hip and knee bend so that the ankle meets a point.
//!
//! Analytic, by the law of cosines. The leg stays in its plane, which turns with the line from hip to ankle, so the
//! knee remains the hinge that the pose had.
//!
//! Any frame in which the body's forward direction at rest is x; metres; orientations are relative to the rest pose.

use std::f32::consts::PI;

use glam::{Quat, Vec3};

/// Greatest distance from hip to ankle, divided by thigh plus shank: the angle of a straight knee changes infinitely
/// fast.
pub(crate) const EXTENSION_MAX: f32 = 0.999;
/// Least distance from hip to ankle, divided by the difference of thigh and shank: the angle of a folded knee changes
/// infinitely fast, too.
const FLEXION_MARGIN: f32 = 1.001;
/// Distance of a straight leg's knee before the line from hip to ankle, m: it gives the leg a plane, bent forward. At 1
/// mm the knee swings out to the side where the pose difference after a switch straightens the leg.
const KNEE_AHEAD_M: f32 = 0.02;
/// 1 + cosine of the angle above which rounding leaves two directions no common axis: π − 1 mrad.
const OPPOSITE: f32 = 5e-7;

/// A leg in a pose.
#[derive(Clone, Copy, Debug)]
pub struct TwoBones {
    /// Hip, knee and ankle, m.
    pub positions_m: [Vec3; 3],
    /// Orientations of thigh and shank.
    pub orientations: [Quat; 2],
    /// Lengths of thigh and shank, m.
    pub lengths_m: [f32; 2],
}

/// Orientations of thigh and shank with which the ankle meets a point, or the nearest point in reach.
///
/// Within its plane each bone turns to where the law of cosines requires it. Then the plane turns from the old line
/// between hip and ankle to the new one.
pub fn reach(leg: &TwoBones, ankle_m: Vec3) -> [Quat; 2] {
    let [hip_m, knee_m, old_ankle_m] = leg.positions_m;
    let [old_thigh, old_shank] = leg.orientations;
    let (thigh_m, shank_m, line_m) = (knee_m - hip_m, old_ankle_m - knee_m, old_ankle_m - hip_m);
    let to_target_m = ankle_m - hip_m;

    let (line_length_m, target_length_m) = (line_m.length(), to_target_m.length());
    let line = if line_length_m > 0.0 { line_m / line_length_m } else { Vec3::NEG_Z };
    let distance_m = reachable_m(leg.lengths_m, target_length_m);
    let (along_m, across_m) = knee_offset_m(leg.lengths_m, distance_m);
    let bent_thigh_m = along_m * line + across_m * knee_direction(thigh_m, old_thigh * Vec3::X, line);
    let bent_shank_m = distance_m * line - bent_thigh_m;

    let swing = shortest_arc(line_m, to_target_m, line_length_m * target_length_m);
    let [thigh_length_m, shank_length_m] = leg.lengths_m;
    let bend_thigh = shortest_arc(thigh_m, bent_thigh_m, thigh_length_m * thigh_length_m);
    let bend_shank = shortest_arc(shank_m, bent_shank_m, shank_length_m * shank_length_m);
    [(swing * bend_thigh * old_thigh).normalize(), (swing * bend_shank * old_shank).normalize()]
}

/// The distance from hip to ankle nearest to `distance_m` that a leg can have, m.
pub fn reachable_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> f32 {
    let least_m = FLEXION_MARGIN * (thigh_m - shank_m).abs();
    distance_m.clamp(least_m, (EXTENSION_MAX * (thigh_m + shank_m)).max(least_m))
}

/// Position of the knee relative to the hip, along the line from hip to ankle and across it, m (law of cosines).
fn knee_offset_m([thigh_m, shank_m]: [f32; 2], distance_m: f32) -> (f32, f32) {
    let distance_m = distance_m.max(f32::EPSILON);
    let along_m = 0.5 * (distance_m + (thigh_m * thigh_m - shank_m * shank_m) / distance_m);
    (along_m, libm::sqrtf((thigh_m * thigh_m - along_m * along_m).max(0.0)))
}

/// Unit vector across the line from hip to ankle to which the knee bends: that of the pose, turned forward. The
/// difference of poses after a switch may hyperextend a knee; it then bends forward on the same hinge.
fn knee_direction(knee_m: Vec3, forward: Vec3, line: Vec3) -> Vec3 {
    let across = |vector: Vec3| vector - line * vector.dot(line);
    let forward = across(forward).try_normalize().unwrap_or_else(|| line.any_orthonormal_vector());
    let knee_m = across(knee_m);
    let ahead_m = knee_m.dot(forward);
    (knee_m + (libm::sqrtf(ahead_m * ahead_m + KNEE_AHEAD_M * KNEE_AHEAD_M) - ahead_m) * forward).normalize()
}

/// The shortest rotation from the direction of one vector to that of another, not normalised, given the product of
/// their lengths. Exact for small angles. Opposite vectors give a half turn about any axis across; a zero vector gives
/// none.
pub(crate) fn shortest_arc(from: Vec3, to: Vec3, lengths: f32) -> Quat {
    let (cross, one_plus_cosine) = (from.cross(to), lengths + from.dot(to));
    if one_plus_cosine > OPPOSITE * lengths {
        Quat::from_xyzw(cross.x, cross.y, cross.z, one_plus_cosine)
    } else if lengths > 0.0 {
        Quat::from_axis_angle(from.normalize().any_orthonormal_vector(), PI)
    } else {
        Quat::IDENTITY
    }
}

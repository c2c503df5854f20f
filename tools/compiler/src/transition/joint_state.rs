//! Positions and velocities of all joints at one instant, and the distance of two such states whatever the place and the
//! direction of the bodies on the ground (Kovar, Gleicher & Pighin 2002, "Motion Graphs", §3.1, with joints as the cloud
//! of points).
//!
//! With joints x_j and their velocities v_j, placed by a turn θ about the vertical and a shift t on the ground,
//!
//! ```text
//! D² = min over θ, t of mean over joints |R(θ)·x_j + t − x'_j|²,   then plus w²·|R(θ)·v_j − v'_j|²
//! ```
//!
//! The minimum over θ and t has a closed form. Metres, seconds, radians.

use glam::{DVec2, DVec3, Vec3};
use motiondb::body::JOINT_COUNT;

use crate::ground::rotations::ground_rotation;

/// w: weight of a joint's velocity beside its position, s, as in [`motiondb::motion::distances_m`].
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// Where a body is on the ground: position (m) and direction (rad).
pub(crate) type Placement = (DVec2, f64);

/// The joints of a body at one instant, in one frame. In f32: a set of hundreds of examples has a hundred thousand.
#[derive(Clone, Debug)]
pub(crate) struct JointState {
    /// Positions, m.
    pub(crate) positions_m: [Vec3; JOINT_COUNT],
    /// Velocities, m/s.
    pub(crate) velocities_mps: [Vec3; JOINT_COUNT],
}

impl JointState {
    /// The state between two poses `span_s` apart.
    pub(crate) fn between(
        before_m: &[DVec3; JOINT_COUNT],
        at_m: [DVec3; JOINT_COUNT],
        after_m: &[DVec3; JOINT_COUNT],
        span_s: f64,
    ) -> Self {
        let velocity_mps = |joint: usize| ((after_m[joint] - before_m[joint]) / span_s).as_vec3();
        Self { positions_m: at_m.map(|at_m| at_m.as_vec3()), velocities_mps: std::array::from_fn(velocity_mps) }
    }

    /// Whether the distance to another state exceeds a limit, m, by heights and vertical velocities alone: no placement
    /// changes them. This costs a tenth of [`Self::placed_on`].
    pub(crate) fn is_farther(&self, other: &Self, limit_m: f64) -> bool {
        let weight_s = VELOCITY_WEIGHT_S as f32;
        let of_joint = |joint: usize| {
            let height_m = self.positions_m[joint].z - other.positions_m[joint].z;
            let weighted_m = weight_s * (self.velocities_mps[joint].z - other.velocities_mps[joint].z);
            height_m * height_m + weighted_m * weighted_m
        };
        let squares: f32 = (0..JOINT_COUNT).map(of_joint).sum();
        f64::from(squares) > limit_m * limit_m * JOINT_COUNT as f64
    }

    /// Where this state must be placed so that its joints are nearest to those of another, and the distances then: of
    /// the positions alone, and of positions and velocities, m.
    pub(crate) fn placed_on(&self, other: &Self) -> (Placement, [f64; 2]) {
        let (position_m, facing_rad) = placement(&self.positions_m, &other.positions_m);
        let rotation = ground_rotation(facing_rad);
        let turned = |vector: Vec3| (rotation * vector.truncate().as_dvec2()).extend(f64::from(vector.z));
        let squares = |joint: usize| {
            let placed_m = turned(self.positions_m[joint]) + position_m.extend(0.0);
            let velocity_mps = turned(self.velocities_mps[joint]);
            let other_mps = other.velocities_mps[joint].as_dvec3();
            [
                placed_m.distance_squared(other.positions_m[joint].as_dvec3()),
                VELOCITY_WEIGHT_S * VELOCITY_WEIGHT_S * velocity_mps.distance_squared(other_mps),
            ]
        };
        let [positions, velocities] =
            (0..JOINT_COUNT).map(squares).fold([0.0; 2], |sums, squares| [sums[0] + squares[0], sums[1] + squares[1]]);
        let rms_m = |sum: f64| libm::sqrt(sum / JOINT_COUNT as f64);
        ((position_m, facing_rad), [rms_m(positions), rms_m(positions + velocities)])
    }
}

/// The shift (m) and the turn (rad) on the ground that bring points nearest to others.
fn placement(points_m: &[Vec3; JOINT_COUNT], others_m: &[Vec3; JOINT_COUNT]) -> Placement {
    let on_ground = |point_m: &Vec3| point_m.truncate().as_dvec2();
    let middle = |points_m: &[Vec3; JOINT_COUNT]| points_m.iter().map(on_ground).sum::<DVec2>() / JOINT_COUNT as f64;
    let (own_middle_m, other_middle_m) = (middle(points_m), middle(others_m));
    let (mut along, mut across) = (0.0, 0.0);
    for (own_m, other_m) in points_m.iter().zip(others_m) {
        let (own_m, other_m) = (on_ground(own_m) - own_middle_m, on_ground(other_m) - other_middle_m);
        along += own_m.dot(other_m);
        across += own_m.perp_dot(other_m);
    }
    let facing_rad = libm::atan2(across, along);
    (other_middle_m - ground_rotation(facing_rad) * own_middle_m, facing_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{SyntheticWalk, walk};

    #[test]
    fn the_same_motion_elsewhere_has_no_distance() {
        let clip = walk("walk", SyntheticWalk::default());
        let positions_m = |frame: usize| clip.frames[frame].forward_kinematics(&clip.body).positions_m;
        let here = JointState::between(&positions_m(20), positions_m(21), &positions_m(22), 2.0 / 60.0);
        let (shift_m, turn_rad) = (DVec2::new(3.0, -1.0), 2.5);
        let moved = |frame: usize| {
            let turned = |point_m: DVec3| (ground_rotation(turn_rad) * point_m.truncate() + shift_m).extend(point_m.z);
            positions_m(frame).map(turned)
        };
        let there = JointState::between(&moved(20), moved(21), &moved(22), 2.0 / 60.0);
        let ((position_m, facing_rad), distances_m) = here.placed_on(&there);
        assert!(
            position_m.distance(shift_m) < 1e-5 && (facing_rad - turn_rad).abs() < 1e-5,
            "{position_m}, {facing_rad}"
        );
        assert!(distances_m.iter().all(|distance_m| *distance_m < 1e-5), "{distances_m:?}");
        let later = JointState::between(&positions_m(40), positions_m(41), &positions_m(42), 2.0 / 60.0);
        let distance_m = here.placed_on(&later).1[1];
        assert!(distance_m > 0.05);
        for limit_m in [0.0, 0.01, 0.02, 0.05, 0.1, 0.2] {
            assert!(!here.is_farther(&later, limit_m) || distance_m > limit_m, "{distance_m} m, limit {limit_m} m");
        }
        assert!(here.is_farther(&later, 0.01));
    }
}

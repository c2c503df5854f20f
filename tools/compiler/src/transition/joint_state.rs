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

use glam::{DVec2, DVec3};
use motiondb::body::JOINT_COUNT;

use crate::ground::rotations::ground_rotation;

/// w: weight of a joint's velocity beside its position, s, as in [`motiondb::motion::distances_m`].
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// Where a body is on the ground: position (m) and direction (rad).
pub(crate) type Placement = (DVec2, f64);

/// The joints of a body at one instant, in one frame.
#[derive(Clone, Debug)]
pub(crate) struct JointState {
    /// Positions, m.
    pub(crate) positions_m: [DVec3; JOINT_COUNT],
    /// Velocities, m/s.
    pub(crate) velocities_mps: [DVec3; JOINT_COUNT],
}

impl JointState {
    /// The state between two poses `span_s` apart.
    pub(crate) fn between(
        before_m: &[DVec3; JOINT_COUNT],
        at_m: [DVec3; JOINT_COUNT],
        after_m: &[DVec3; JOINT_COUNT],
        span_s: f64,
    ) -> Self {
        let velocity_mps = |joint: usize| (after_m[joint] - before_m[joint]) / span_s;
        Self { positions_m: at_m, velocities_mps: std::array::from_fn(velocity_mps) }
    }

    /// Where this state must be placed so that its joints are nearest to those of another, and the distances then: of
    /// the positions alone, and of positions and velocities, m.
    pub(crate) fn placed_on(&self, other: &Self) -> (Placement, [f64; 2]) {
        let (position_m, facing_rad) = placement(&self.positions_m, &other.positions_m);
        let rotation = ground_rotation(facing_rad);
        let turned = |vector: DVec3| (rotation * vector.truncate()).extend(vector.z);
        let squares = |joint: usize| {
            let placed_m = turned(self.positions_m[joint]) + position_m.extend(0.0);
            let velocity_mps = turned(self.velocities_mps[joint]);
            [
                placed_m.distance_squared(other.positions_m[joint]),
                VELOCITY_WEIGHT_S * VELOCITY_WEIGHT_S * velocity_mps.distance_squared(other.velocities_mps[joint]),
            ]
        };
        let [positions, velocities] =
            (0..JOINT_COUNT).map(squares).fold([0.0; 2], |sums, squares| [sums[0] + squares[0], sums[1] + squares[1]]);
        let rms_m = |sum: f64| libm::sqrt(sum / JOINT_COUNT as f64);
        ((position_m, facing_rad), [rms_m(positions), rms_m(positions + velocities)])
    }
}

/// The shift (m) and the turn (rad) on the ground that bring points nearest to others.
fn placement(points_m: &[DVec3; JOINT_COUNT], others_m: &[DVec3; JOINT_COUNT]) -> Placement {
    let middle = |points_m: &[DVec3; JOINT_COUNT]| points_m.iter().sum::<DVec3>().truncate() / JOINT_COUNT as f64;
    let (own_middle_m, other_middle_m) = (middle(points_m), middle(others_m));
    let (mut along, mut across) = (0.0, 0.0);
    for (own_m, other_m) in points_m.iter().zip(others_m) {
        let (own_m, other_m) = (own_m.truncate() - own_middle_m, other_m.truncate() - other_middle_m);
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
        let moved = |vector: &DVec3| (ground_rotation(turn_rad) * vector.truncate()).extend(vector.z);
        let there = JointState {
            positions_m: here.positions_m.each_ref().map(|point_m| moved(point_m) + shift_m.extend(0.0)),
            velocities_mps: here.velocities_mps.each_ref().map(moved),
        };
        let ((position_m, facing_rad), distances_m) = here.placed_on(&there);
        assert!(
            position_m.distance(shift_m) < 1e-9 && (facing_rad - turn_rad).abs() < 1e-9,
            "{position_m}, {facing_rad}"
        );
        assert!(distances_m.iter().all(|distance_m| *distance_m < 1e-9), "{distances_m:?}");
        let later = JointState::between(&positions_m(40), positions_m(41), &positions_m(42), 2.0 / 60.0);
        assert!(here.placed_on(&later).1[1] > 0.05);
    }
}

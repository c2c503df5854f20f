//! Foot room: a swinging foot moves back towards the room that walls and other bodies leave. `FbCrowd` does not have it.
//!
//! Strides reach beyond discs: a foot may land in a wall, or on the foot of another body. So where a sole would be beyond
//! a side of the elbow room ([`crate::planning::elbow_room`]), the foot moves back by the difference, one side after the
//! other; walls, which come last, count most. Leg clearance comes after it, and may lead out again. A planted foot stays
//! where it is.
//!
//! Frame of the drawn body (x forward, y left), metres.

use glam::{Vec2, Vec3};

use crate::planning::elbow_room::ElbowRoom;

/// Greatest displacement, m: farther back a foot would land too far from where the leg swings to (docs/tuning.md).
const BACK_MAX_M: f32 = 0.1;

/// Displacement by which a foot moves back towards the room, m, given its sole where it will be, and the radius of the foot.
pub(crate) fn back_m(sole_m: [Vec3; 3], radius_m: f32, room: &ElbowRoom) -> Vec2 {
    let mut back_m = Vec2::ZERO;
    for side in room.sides() {
        let out_m = sole_m.map(|point_m| side.towards.dot(point_m.truncate() + back_m));
        let farthest_m = out_m.into_iter().fold(f32::NEG_INFINITY, f32::max);
        back_m -= (farthest_m + radius_m - side.distance_m).max(0.0) * side.towards;
    }
    back_m.clamp_length_max(BACK_MAX_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacement of a foot that points ahead, its toe tip .2 m before the body, 5 cm thick about its middle.
    fn displaced_m(ends_m: &[Vec2]) -> Vec2 {
        let sole_m = [-0.05, 0.13, 0.2].map(|along_m| Vec3::new(along_m, 0.1, 0.0));
        back_m(sole_m, 0.05, &ElbowRoom::ending_at(ends_m.iter().copied()))
    }

    #[test]
    fn a_foot_moves_back_by_what_is_beyond_a_side() {
        assert_eq!(displaced_m(&[]), Vec2::ZERO);
        assert_eq!(displaced_m(&[0.26 * Vec2::X, 0.16 * Vec2::Y]), Vec2::ZERO);
        assert!(displaced_m(&[0.2 * Vec2::X]).distance(-0.05 * Vec2::X) < 1e-6);
        assert!(displaced_m(&[0.2 * Vec2::X, 0.12 * Vec2::Y]).distance(Vec2::new(-0.05, -0.03)) < 1e-6);
        assert_eq!(displaced_m(&[0.1 * Vec2::X]), -BACK_MAX_M * Vec2::X);
    }

    #[test]
    fn between_two_sides_the_later_counts() {
        let [ahead, behind] = [0.2 * Vec2::X, -0.05 * Vec2::X];
        assert!(displaced_m(&[ahead, behind]).distance(0.05 * Vec2::X) < 1e-6);
        assert!(displaced_m(&[behind, ahead]).distance(-0.05 * Vec2::X) < 1e-6);
    }
}

//! Half-planes of the velocities that the motion database can realise (`FbCrowd` §4.1, Eqs. 2–5; `definitions.md`).
//!
//! The turning set limits a body whose facing follows its velocity, the holding set one that holds its facing. Both are
//! convex, clockwise, and count the origin; each edge gives one half-plane, rotated by the agent's facing. While v_pref
//! lies more than 90° off the facing, the wrapping polygon's sharp-turn edges on the side of the turn join the turning
//! set.

use glam::Vec2;
use motiondb::velocity_hull::{HALF_WIDTH_MPS, VelocityHull, half_plane, half_planes};

use super::half_plane::{HalfPlane, Source};
use crate::plan::VelocitySet;

/// Eqs. 4, 5: appends a set's half-planes, in world axes; `forward` is the agent's facing.
pub fn hull_half_planes(corners_mps: &[Vec2], forward: Vec2, source: Source, found: &mut Vec<HalfPlane>) {
    found.extend(half_planes(corners_mps).map(|half_plane| rotated(half_plane, forward, source)));
}

/// Appends the sharp-turn edges for a v_pref more than 90° off the facing; none otherwise.
pub fn sharp_turn_half_planes(edges_mps: &[[Vec2; 2]], forward: Vec2, preferred_mps: Vec2, found: &mut Vec<HalfPlane>) {
    if preferred_mps.dot(forward) >= 0.0 {
        return;
    }
    let turns_left = forward.perp_dot(preferred_mps) > 0.0;
    let on_the_side_of_the_turn = |end: &Vec2| end.x < 0.0 && if turns_left { end.y >= 0.0 } else { end.y <= 0.0 };
    for edge in edges_mps.iter().filter(|edge| edge.iter().any(on_the_side_of_the_turn)) {
        found.extend(half_plane(edge[0], edge[1]).map(|half_plane| rotated(half_plane, forward, Source::SharpTurn)));
    }
}

/// The corners of a set and the source that its half-planes carry.
pub fn set(hull: &VelocityHull, set: VelocitySet) -> (&[Vec2], Source) {
    match set {
        VelocitySet::Turning => (&hull.turning_mps, Source::TurningHull),
        VelocitySet::Holding => (&hull.holding_mps, Source::HoldingHull),
    }
}

/// How far outside a set a velocity lies, m/s, for a body that faces `forward`; negative inside.
pub fn outside_mps(corners_mps: &[Vec2], forward: Vec2, velocity_mps: Vec2, scratch: &mut Vec<HalfPlane>) -> f32 {
    scratch.clear();
    hull_half_planes(corners_mps, forward, Source::HoldingHull, scratch);
    scratch.iter().map(|half_plane| half_plane.violation_mps(velocity_mps)).fold(f32::NEG_INFINITY, f32::max)
}

/// The greatest speed of a set, m/s.
pub fn speed_max_mps(corners_mps: &[Vec2]) -> f32 {
    let squared = corners_mps.iter().map(|corner_mps| corner_mps.length_squared());
    squared.fold(HALF_WIDTH_MPS * HALF_WIDTH_MPS, f32::max).sqrt()
}

/// From the agent's frame to the world's axes.
fn rotated((point_mps, direction): (Vec2, Vec2), forward: Vec2, source: Source) -> HalfPlane {
    HalfPlane::new(forward.rotate(point_mps), forward.rotate(direction), source)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A kite, clockwise: 2 m/s ahead, 0.8 to the sides, 0.4 back.
    const KITE: [Vec2; 4] = [Vec2::new(2.0, 0.0), Vec2::new(0.0, -0.8), Vec2::new(-0.4, 0.0), Vec2::new(0.0, 0.8)];

    fn permits(half_planes: &[HalfPlane], velocity_mps: Vec2) -> bool {
        half_planes.iter().all(|half_plane| half_plane.violation_mps(velocity_mps) <= 0.0)
    }

    proptest! {
        #[test]
        fn permits_the_inside_of_the_rotated_set(facing in -4.0f32..4.0, x in -3.0f32..3.0, y in -3.0f32..3.0) {
            let (sin, cos) = libm::sincosf(facing);
            let local = Vec2::new(x, y);
            let inside = y.abs() / 0.8 + if x > 0.0 { x / 2.0 } else { -x / 0.4 } <= 1.0;
            let mut half_planes = Vec::new();
            hull_half_planes(&KITE, Vec2::new(cos, sin), Source::TurningHull, &mut half_planes);
            let edge = (y.abs() / 0.8 + if x > 0.0 { x / 2.0 } else { -x / 0.4 } - 1.0).abs() < 1e-4;
            prop_assert!(edge || permits(&half_planes, Vec2::new(cos, sin).rotate(local)) == inside);
        }
    }

    #[test]
    fn a_set_of_one_or_two_corners_permits_standing_and_walking_along_it() {
        for corners_mps in [vec![Vec2::new(1.2, 0.0)], vec![Vec2::ZERO, Vec2::new(1.2, 0.0)]] {
            let mut half_planes = Vec::new();
            hull_half_planes(&corners_mps, Vec2::Y, Source::TurningHull, &mut half_planes);
            assert!(permits(&half_planes, Vec2::ZERO) && permits(&half_planes, Vec2::new(0.0, 1.2)));
            assert!(!permits(&half_planes, Vec2::new(0.1, 0.6)) && !permits(&half_planes, Vec2::new(0.0, -0.1)));
        }
    }

    #[test]
    fn sharp_turns_bind_only_on_the_side_of_a_turn_of_more_than_90_degrees() {
        let left = [Vec2::new(-0.4, 0.01), Vec2::new(0.0, 0.8)];
        let right = [Vec2::new(0.0, -0.8), Vec2::new(-0.4, -0.01)];
        for (preferred, count) in [(Vec2::X, 0), (Vec2::new(-1.0, 0.5), 1), (Vec2::new(-1.0, -0.5), 1)] {
            let mut half_planes = Vec::new();
            sharp_turn_half_planes(&[left, right], Vec2::X, preferred, &mut half_planes);
            assert_eq!(half_planes.len(), count, "{preferred}");
            assert!(permits(&half_planes, Vec2::ZERO));
        }
    }
}

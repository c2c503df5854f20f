//! Half-planes of the velocities that the motion database can realise (`FbCrowd` §4.1, Eqs. 2–5; `definitions.md`).
//!
//! The turning set limits a body whose facing follows its velocity, the holding set one that holds its facing. Both are
//! convex, clockwise, and count the origin; each edge gives one half-plane, rotated by the agent's facing.
//!
//! While v_pref lies more than 90° off the facing, the sharp-turn edge of the wrapping polygon that the turn meets joins
//! the turning set: the one whose cone, seen from rest, holds v_pref. The polygon is star-shaped but not convex, so an
//! edge tells permitted from forbidden velocities in its own cone only. Beyond it, its line may cut off what the polygon
//! holds; all edges of a side at once forbid most of that side, and walking on ahead with it.

use glam::Vec2;
use motiondb::velocity_hull::{HALF_WIDTH_MPS, VelocityHull, half_plane, half_planes};

use super::half_plane::{HalfPlane, Source};
use crate::plan::VelocitySet;

/// Eqs. 4, 5: appends a set's half-planes, in world axes; `forward` is the agent's facing.
pub fn hull_half_planes(corners_mps: &[Vec2], forward: Vec2, source: Source, found: &mut Vec<HalfPlane>) {
    found.extend(half_planes(corners_mps).map(|half_plane| rotated(half_plane, forward, source)));
}

/// The half-plane of the sharp-turn edge that a v_pref more than 90° off the facing meets; none otherwise, nor where the
/// polygon has no edge that way.
pub fn sharp_turn_half_plane(edges_mps: &[[Vec2; 2]], forward: Vec2, preferred_mps: Vec2) -> Option<HalfPlane> {
    let wanted_mps = Vec2::new(forward.dot(preferred_mps), forward.perp_dot(preferred_mps));
    if wanted_mps.x >= 0.0 {
        return None;
    }
    let holds = |[from, to]: &&[Vec2; 2]| from.perp_dot(wanted_mps) <= 0.0 && wanted_mps.perp_dot(*to) <= 0.0;
    let [from, to] = edges_mps.iter().find(holds)?;
    half_plane(*from, *to).map(|half_plane| rotated(half_plane, forward, Source::SharpTurn))
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

    /// A side's sharp turns as the bundled clips have them: slow on the tightest, fast on the one before, slow at 90°.
    const LEFT: [Vec2; 4] = [Vec2::new(-0.3, 0.35), Vec2::new(-0.6, 1.6), Vec2::new(-0.01, 0.65), Vec2::new(1.1, 2.0)];

    /// Edges of the wrapping polygon, clockwise from the left side's through ahead to that behind.
    fn sharp_turn_edges() -> Vec<[Vec2; 2]> {
        let right = LEFT.map(|corner| corner * Vec2::new(1.0, -1.0));
        let left_edges = LEFT.windows(2).map(|edge| [edge[0], edge[1]]);
        let right_edges = right.windows(2).rev().map(|edge| [edge[1], edge[0]]);
        left_edges.chain(right_edges).chain([[right[0], LEFT[0]]]).collect()
    }

    /// Whether a velocity lies in a triangle that rest spans with an edge.
    fn in_the_polygon(velocity_mps: Vec2) -> bool {
        let left_of = |from: Vec2, to: Vec2| (to - from).perp_dot(velocity_mps - from) >= 0.0;
        sharp_turn_edges()
            .iter()
            .any(|&[from, to]| left_of(to, from) && left_of(from, Vec2::ZERO) && left_of(Vec2::ZERO, to))
    }

    proptest! {
        #[test]
        fn towards_v_pref_a_sharp_turn_permits_just_what_the_wrapping_polygon_holds(
            facing in -4.0f32..4.0, turn in 1.6f32..std::f32::consts::PI, left in any::<bool>(), speed_mps in 0.01f32..2.0,
        ) {
            let [forward, wanted] = [0.0, if left { turn } else { -turn }].map(|turn| Vec2::from_angle(facing + turn));
            let half_plane = sharp_turn_half_plane(&sharp_turn_edges(), forward, wanted);
            let local_mps = |speed_mps: f32| speed_mps * Vec2::from_angle(if left { turn } else { -turn });
            prop_assume!(in_the_polygon(local_mps(speed_mps + 1e-3)) == in_the_polygon(local_mps(speed_mps - 1e-3)));
            let permitted = half_plane.is_none_or(|half_plane| half_plane.violation_mps(speed_mps * wanted) <= 0.0);
            prop_assert_eq!(permitted, in_the_polygon(local_mps(speed_mps)));
        }
    }

    #[test]
    fn a_sharp_turn_leaves_standing_and_walking_on_ahead_alone() {
        let edges_mps = sharp_turn_edges();
        for preferred_mps in [Vec2::new(-0.7, 0.9), Vec2::new(-1.0, -1.2), -Vec2::X] {
            let half_plane = sharp_turn_half_plane(&edges_mps, Vec2::X, preferred_mps).unwrap();
            assert!(permits(&[half_plane], Vec2::ZERO) && permits(&[half_plane], 1.4 * Vec2::X), "{preferred_mps}");
        }
    }

    #[test]
    fn no_sharp_turn_binds_a_turn_of_less_than_90_degrees_or_where_no_edge_lies() {
        let edges_mps = sharp_turn_edges();
        assert!(sharp_turn_half_plane(&edges_mps, Vec2::X, Vec2::new(0.01, 1.0)).is_none());
        assert!(sharp_turn_half_plane(&edges_mps[..3], Vec2::X, Vec2::new(-1.0, -0.5)).is_none());
    }
}

//! Half-planes of the velocities that the motion database can realise, C_motion without the stance foot (`FbCrowd`
//! §4.1, Eqs. 2–5).
//!
//! The turning set limits a body whose facing follows its velocity, the holding set one that holds its facing. Both are
//! convex, clockwise, and count the origin; each edge gives one half-plane, rotated by the agent's facing.
//!
//! While v_pref lies more than 90° off the facing, one sharp-turn edge of the wrapping polygon joins the turning set:
//! the edge whose cone, seen from rest, holds v_pref. The polygon is star-shaped but not convex, so an edge separates
//! permitted from forbidden velocities in its own cone only. Beyond it, its line may cut off what the polygon holds;
//! all edges of a side at once forbid most of that side, and walking straight on.
//!
//! Agent's frame (x forward, y left) inside the sets, world axes outside; m/s.

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::{Construction, HALF_WIDTH_MPS, VelocityHull, half_plane, half_planes};

use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::plan::VelocitySet;

/// The constraints of a database's velocity sets, in the agent's frame, ready to be rotated: built once, used by every
/// plan.
#[derive(Clone, Debug)]
pub struct MotionConstraints {
    /// How the sets were built.
    pub construction: Construction,
    turning: ConvexSet,
    holding: ConvexSet,
    sharp_turn_edges_mps: Vec<[Vec2; 2]>,
}

/// A convex set of velocities in the agent's frame.
#[derive(Clone, Debug)]
pub struct ConvexSet {
    /// Eqs. 4, 5: a point and a unit direction for each edge; permitted is the left side.
    half_planes: Vec<(Vec2, Vec2)>,
    /// Greatest speed of the set, m/s.
    pub speed_max_mps: f32,
}

impl MotionConstraints {
    /// The constraints of a database's velocity sets.
    pub fn new(hull: &VelocityHull) -> Self {
        Self {
            construction: hull.construction,
            turning: ConvexSet::new(&hull.turning_mps),
            holding: ConvexSet::new(&hull.holding_mps),
            sharp_turn_edges_mps: hull.sharp_turn_edges_mps.clone(),
        }
    }

    /// One of the two sets.
    pub fn set(&self, set: VelocitySet) -> &ConvexSet {
        match set {
            VelocitySet::Turning => &self.turning,
            VelocitySet::Holding => &self.holding,
        }
    }

    /// The half-plane, in world axes, of the sharp-turn edge whose cone holds v_pref, of a body whose velocities are
    /// `factor` times those of the set. None where v_pref lies within 90° of the facing, nor where the polygon has no
    /// edge in that direction.
    pub fn sharp_turn(&self, forward: Vec2, preferred_mps: Vec2, factor: f32) -> Option<HalfPlane> {
        let local_mps = to_agent_frame(preferred_mps, forward);
        if local_mps.x >= 0.0 {
            return None;
        }
        let holds = |[from, to]: &&[Vec2; 2]| from.perp_dot(local_mps) <= 0.0 && local_mps.perp_dot(*to) <= 0.0;
        let [from, to] = self.sharp_turn_edges_mps.iter().find(holds)?;
        let half_plane = half_plane(*from, *to);
        half_plane.map(|half_plane| to_world(half_plane, forward, factor, HalfPlaneSource::SharpTurn))
    }
}

impl ConvexSet {
    /// The set of some corners in clockwise order, m/s.
    pub fn new(corners_mps: &[Vec2]) -> Self {
        let squared = corners_mps.iter().map(|corner_mps| corner_mps.length_squared());
        Self {
            half_planes: half_planes(corners_mps).collect(), // Eqs. 4, 5
            speed_max_mps: squared.fold(HALF_WIDTH_MPS * HALF_WIDTH_MPS, f32::max).sqrt(),
        }
    }

    /// The set's half-planes in world axes, of a body whose velocities are `factor` times those of the set; `forward`
    /// is the agent's facing.
    pub fn half_planes(&self, forward: Vec2, factor: f32, source: HalfPlaneSource) -> impl Iterator<Item = HalfPlane> {
        self.half_planes.iter().map(move |&half_plane| to_world(half_plane, forward, factor, source))
    }

    /// Distance of a velocity from the set of an agent that faces `forward`, of a body whose velocities are `factor`
    /// times those of the set, m/s; negative inside.
    pub fn outside_mps(&self, forward: Vec2, factor: f32, velocity_mps: Vec2) -> f32 {
        let velocity_mps = to_agent_frame(velocity_mps, forward);
        let outside_mps =
            |&(point_mps, direction): &(Vec2, Vec2)| direction.perp_dot(factor * point_mps - velocity_mps);
        self.half_planes.iter().map(outside_mps).fold(f32::NEG_INFINITY, f32::max)
    }
}

fn to_agent_frame(velocity_mps: Vec2, forward: Vec2) -> Vec2 {
    Vec2::new(forward.dot(velocity_mps), forward.perp_dot(velocity_mps))
}

fn to_world((point_mps, direction): (Vec2, Vec2), forward: Vec2, factor: f32, source: HalfPlaneSource) -> HalfPlane {
    HalfPlane::new(forward.rotate(factor * point_mps), forward.rotate(direction), source)
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

    fn world_half_planes(corners_mps: &[Vec2], forward: Vec2) -> Vec<HalfPlane> {
        ConvexSet::new(corners_mps).half_planes(forward, 1.0, HalfPlaneSource::TurningHull).collect()
    }

    proptest! {
        #[test]
        fn distances_are_equal_in_both_frames(
            facing in -4.0f32..4.0, x in -3.0f32..3.0, y in -3.0f32..3.0,
        ) {
            let (forward, velocity_mps) = (Vec2::from_angle(facing), Vec2::new(x, y));
            let in_world = world_half_planes(&KITE, forward);
            let in_world_mps = in_world.iter().map(|half_plane| half_plane.violation_mps(velocity_mps));
            let in_world_mps = in_world_mps.fold(f32::NEG_INFINITY, f32::max);
            prop_assert!((ConvexSet::new(&KITE).outside_mps(forward, 1.0, velocity_mps) - in_world_mps).abs() < 1e-5);
        }

        #[test]
        fn permits_the_inside_of_the_rotated_set(facing in -4.0f32..4.0, x in -3.0f32..3.0, y in -3.0f32..3.0) {
            let (sin, cos) = libm::sincosf(facing);
            let local = Vec2::new(x, y);
            let inside = y.abs() / 0.8 + if x > 0.0 { x / 2.0 } else { -x / 0.4 } <= 1.0;
            let half_planes = world_half_planes(&KITE, Vec2::new(cos, sin));
            let edge = (y.abs() / 0.8 + if x > 0.0 { x / 2.0 } else { -x / 0.4 } - 1.0).abs() < 1e-4;
            prop_assert!(edge || permits(&half_planes, Vec2::new(cos, sin).rotate(local)) == inside);
        }
    }

    #[test]
    fn degenerate_set_permits_its_line() {
        for corners_mps in [vec![Vec2::new(1.2, 0.0)], vec![Vec2::ZERO, Vec2::new(1.2, 0.0)]] {
            let half_planes = world_half_planes(&corners_mps, Vec2::Y);
            assert!(permits(&half_planes, Vec2::ZERO) && permits(&half_planes, Vec2::new(0.0, 1.2)));
            assert!(!permits(&half_planes, Vec2::new(0.1, 0.6)) && !permits(&half_planes, Vec2::new(0.0, -0.1)));
        }
    }

    /// Sharp turns of the left side as in the bundled clips: slow on the tightest, fast on the next, slow at 90°.
    const LEFT: [Vec2; 4] = [Vec2::new(-0.3, 0.35), Vec2::new(-0.6, 1.6), Vec2::new(-0.01, 0.65), Vec2::new(1.1, 2.0)];

    /// Edges of the wrapping polygon, clockwise: the left side's, the right side's, the one behind.
    fn sharp_turn_edges() -> Vec<[Vec2; 2]> {
        let right = LEFT.map(|corner| corner * Vec2::new(1.0, -1.0));
        let left_edges = LEFT.windows(2).map(|edge| [edge[0], edge[1]]);
        let right_edges = right.windows(2).rev().map(|edge| [edge[1], edge[0]]);
        left_edges.chain(right_edges).chain([[right[0], LEFT[0]]]).collect()
    }

    fn sharp_turns(edges_mps: &[[Vec2; 2]]) -> MotionConstraints {
        MotionConstraints::new(&VelocityHull { sharp_turn_edges_mps: edges_mps.to_vec(), ..VelocityHull::default() })
    }

    /// Whether a velocity lies in a triangle of rest and an edge.
    fn in_the_polygon(velocity_mps: Vec2) -> bool {
        let left_of = |from: Vec2, to: Vec2| (to - from).perp_dot(velocity_mps - from) >= 0.0;
        sharp_turn_edges()
            .iter()
            .any(|&[from, to]| left_of(to, from) && left_of(from, Vec2::ZERO) && left_of(Vec2::ZERO, to))
    }

    proptest! {
        #[test]
        fn sharp_turn_to_v_pref_permits_wrapping_polygon(
            facing in -4.0f32..4.0, turn in 1.6f32..std::f32::consts::PI, left in any::<bool>(), speed_mps in 0.01f32..2.0,
        ) {
            let [forward, preferred] = [0.0, if left { turn } else { -turn }].map(|turn| Vec2::from_angle(facing + turn));
            let half_plane = sharp_turns(&sharp_turn_edges()).sharp_turn(forward, preferred, 1.0);
            let local_mps = |speed_mps: f32| speed_mps * Vec2::from_angle(if left { turn } else { -turn });
            prop_assume!(in_the_polygon(local_mps(speed_mps + 1e-3)) == in_the_polygon(local_mps(speed_mps - 1e-3)));
            let permitted = half_plane.is_none_or(|half_plane| half_plane.violation_mps(speed_mps * preferred) <= 0.0);
            prop_assert_eq!(permitted, in_the_polygon(local_mps(speed_mps)));
        }
    }

    #[test]
    fn edge_at_tight_turn_permits_walking_on() {
        let edges_mps = sharp_turn_edges();
        let permits_walking = |half_plane: HalfPlane| {
            assert!(permits(&[half_plane], Vec2::ZERO));
            permits(&[half_plane], 1.4 * Vec2::X)
        };
        for preferred_mps in [Vec2::new(-0.7, 0.9), Vec2::new(-0.7, -0.9), -Vec2::X] {
            let met = sharp_turns(&edges_mps).sharp_turn(Vec2::X, preferred_mps, 1.0).unwrap();
            assert!(permits_walking(met), "{preferred_mps}");
        }
        let next = half_plane(edges_mps[1][0], edges_mps[1][1]).unwrap();
        assert!(!permits_walking(to_world(next, Vec2::X, 1.0, HalfPlaneSource::SharpTurn)));
    }

    #[test]
    fn gentle_turns_and_missing_edges_are_free() {
        let edges_mps = sharp_turn_edges();
        assert!(sharp_turns(&edges_mps).sharp_turn(Vec2::X, Vec2::new(0.01, 1.0), 1.0).is_none());
        assert!(sharp_turns(&edges_mps[..3]).sharp_turn(Vec2::X, Vec2::new(-1.0, -0.5), 1.0).is_none());
    }
}

//! Half-planes that keep a disc off the walls within the time horizon (`FbCrowd` §4.4, C_iW; van den Berg et al. 2011,
//! §5.4).
//!
//! A wall does not yield, so the agent makes the whole change. Seen from the disc, an edge has a *left* corner (where
//! it begins, the polygon being counter-clockwise) and a *right* one. Cases, in order:
//!
//! 1. covered: the half-planes of nearer edges forbid the whole edge already; nothing to add;
//! 2. contact: the disc overlaps the edge or one of its corners; it may not go deeper;
//! 3. otherwise the edge has a velocity obstacle, bounded by a *leg* from each corner and by a *cut-off* between them,
//!    at 1/τ of the distance. Seen obliquely, one corner bears both legs. A leg never cuts into the neighbouring edge:
//!    it then runs along that edge and is *foreign*, that edge answers for it. At a concave corner the leg prolongs the
//!    edge itself;
//! 4. the half-plane is tangent to the velocity obstacle where the present velocity is nearest to it: at a cut-off
//!    corner, the cut-off line, or a leg.
//!
//! World axes, m and m/s.

use glam::Vec2;

use crate::planning::orca::agent_half_planes::tangent;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::world::disc::Disc;
use crate::world::obstacles::{NearEdge, Obstacles};

/// Slack of the test whether an edge is covered, m/s: RVO2's.
const COVERED_MPS: f32 = 1e-5;

/// A corner of an edge, as the disc sees it.
#[derive(Clone, Copy)]
struct EdgeEnd {
    /// Offset from the disc's centre, m.
    offset_m: Vec2,
    convex: bool,
    /// Unit direction of the edge that arrives here.
    incoming: Vec2,
    /// Unit direction of the edge that leaves here.
    outgoing: Vec2,
}

/// One side of a velocity obstacle.
#[derive(Clone, Copy)]
struct ObstacleLeg {
    /// Unit direction, away from the disc.
    direction: Vec2,
    /// Whether it runs along the neighbouring edge, which answers for it.
    foreign: bool,
}

/// The velocity obstacle of one edge.
struct EdgeVelocityObstacle {
    /// Left and right corner over τ, m/s.
    corners_mps: [Vec2; 2],
    /// Left and right leg.
    legs: [ObstacleLeg; 2],
    /// r/τ, m/s.
    radius_mps: f32,
}

/// C_iW: appends the half-planes of the edges near a disc, which come nearest first.
pub(crate) fn wall_half_planes(
    obstacles: &Obstacles,
    near: &[NearEdge],
    own: &Disc,
    horizon_s: f32,
    found: &mut Vec<HalfPlane>,
) {
    for near_edge in near {
        let ends = seen_from(obstacles, near_edge.edge, own.position_m);
        if !is_covered(&ends, own.radius_m, horizon_s, found) {
            let half_plane = edge_half_plane(ends, own, horizon_s, HalfPlaneSource::Obstacle(near_edge.edge));
            found.extend(half_plane);
        }
    }
}

/// The half-plane of a single wall without thickness; its ends are relative to the disc's centre.
pub(crate) fn segment_half_plane(
    [from_m, to_m]: [Vec2; 2],
    own: &Disc,
    horizon_s: f32,
    source: HalfPlaneSource,
) -> Option<HalfPlane> {
    // The disc is on the outer side, the right one.
    let [left_m, right_m] = if from_m.perp_dot(to_m) >= 0.0 { [to_m, from_m] } else { [from_m, to_m] };
    let along = (right_m - left_m).try_normalize()?;
    let left = EdgeEnd { offset_m: left_m, convex: true, incoming: -along, outgoing: along };
    let right = EdgeEnd { offset_m: right_m, convex: true, incoming: along, outgoing: -along };
    edge_half_plane([left, right], own, horizon_s, source)
}

/// Left and right end of an edge.
fn seen_from(obstacles: &Obstacles, edge: u32, position_m: Vec2) -> [EdgeEnd; 2] {
    let corners = obstacles.corners();
    let end = |index: u32| {
        let corner = &corners[index as usize];
        EdgeEnd {
            offset_m: corner.point_m - position_m,
            convex: corner.convex,
            incoming: corners[corner.previous as usize].direction,
            outgoing: corner.direction,
        }
    };
    [end(edge), end(corners[edge as usize].next)]
}

/// Case 1.
fn is_covered(ends: &[EdgeEnd; 2], radius_m: f32, horizon_s: f32, found: &[HalfPlane]) -> bool {
    found.iter().any(|half_plane| {
        ends.iter().all(|end| half_plane.violation_mps(end.offset_m / horizon_s) >= radius_m / horizon_s - COVERED_MPS)
    })
}

/// Cases 2 to 4; none where a neighbouring edge answers for this one.
fn edge_half_plane(ends: [EdgeEnd; 2], own: &Disc, horizon_s: f32, source: HalfPlaneSource) -> Option<HalfPlane> {
    let [left, right] = ends;
    let along_m = right.offset_m - left.offset_m;
    let share = -left.offset_m.dot(along_m) / along_m.length_squared();
    let touches = |offset_m: Vec2| offset_m.length_squared() <= own.radius_m * own.radius_m;
    let touches_line = touches(left.offset_m + share * along_m);

    // Case 2: the left corner, the right corner, the edge.
    if share < 0.0 && touches(left.offset_m) {
        return left.convex.then(|| stay_off(left.offset_m, source));
    }
    if share > 1.0 && touches(right.offset_m) {
        // The next edge answers for the corner where it faces the disc.
        let is_ours = right.convex && right.offset_m.perp_dot(right.outgoing) >= 0.0;
        return is_ours.then(|| stay_off(right.offset_m, source));
    }
    if (0.0..=1.0).contains(&share) && touches_line {
        return Some(stay_off(left.outgoing.perp(), source));
    }

    // Case 3. Beyond an end of the edge, but within a radius of its line, the disc sees it obliquely.
    let oblique = touches_line;
    let bearers = match oblique {
        true if share < 0.0 => [left, left],
        true => [right, right],
        false => [left, right],
    };
    if oblique && !bearers[0].convex {
        return None;
    }
    let obstacle = EdgeVelocityObstacle::new(&bearers, own.radius_m, horizon_s);
    obstacle.tangent(own.velocity_mps, left.outgoing, oblique, source) // case 4
}

/// Case 2: no velocity towards what is touched.
fn stay_off(towards: Vec2, source: HalfPlaneSource) -> HalfPlane {
    HalfPlane::behind(Vec2::ZERO, towards.normalize_or(Vec2::X), source)
}

fn left_leg(end: &EdgeEnd, radius_m: f32) -> ObstacleLeg {
    if !end.convex {
        return ObstacleLeg { direction: -end.outgoing, foreign: false };
    }
    let direction = tangent(end.offset_m, radius_m);
    let foreign = direction.perp_dot(-end.incoming) >= 0.0;
    ObstacleLeg { direction: if foreign { -end.incoming } else { direction }, foreign }
}

fn right_leg(end: &EdgeEnd, radius_m: f32) -> ObstacleLeg {
    if !end.convex {
        return ObstacleLeg { direction: end.incoming, foreign: false };
    }
    let direction = tangent(end.offset_m, -radius_m);
    let foreign = direction.perp_dot(end.outgoing) <= 0.0;
    ObstacleLeg { direction: if foreign { end.outgoing } else { direction }, foreign }
}

impl EdgeVelocityObstacle {
    /// Case 3, by the ends that bear the left and the right leg.
    fn new(bearers: &[EdgeEnd; 2], radius_m: f32, horizon_s: f32) -> Self {
        Self {
            corners_mps: [0, 1].map(|side| bearers[side].offset_m / horizon_s),
            legs: [left_leg(&bearers[0], radius_m), right_leg(&bearers[1], radius_m)],
            radius_mps: radius_m / horizon_s,
        }
    }

    /// Case 4: the half-plane that touches the velocity obstacle nearest to the velocity; none on a foreign leg.
    fn tangent(&self, velocity_mps: Vec2, edge: Vec2, oblique: bool, source: HalfPlaneSource) -> Option<HalfPlane> {
        let from_corner = self.corners_mps.map(|corner_mps| velocity_mps - corner_mps);
        let along_legs = [0, 1].map(|side| from_corner[side].dot(self.legs[side].direction));
        let cut_off = self.corners_mps[1] - self.corners_mps[0];
        let share = if oblique { 0.5 } else { from_corner[0].dot(cut_off) / cut_off.length_squared() };

        // At a cut-off corner.
        let before_both_legs = along_legs[0] < 0.0 && along_legs[1] < 0.0;
        if (share < 0.0 && along_legs[0] < 0.0) || (oblique && before_both_legs) {
            return Some(self.off_corner(0, from_corner[0], source));
        }
        if share > 1.0 && along_legs[1] < 0.0 {
            return Some(self.off_corner(1, from_corner[1], source));
        }

        // At the cut-off line or at the nearer leg.
        let to_leg = [0, 1].map(|side| {
            let direction = self.legs[side].direction;
            if along_legs[side] < 0.0 { f32::INFINITY } else { from_corner[side].perp_dot(direction).abs() }
        });
        let before_cut_off = !oblique && (0.0..=1.0).contains(&share);
        let to_cut_off = if before_cut_off { from_corner[0].perp_dot(edge).abs() } else { f32::INFINITY };
        if to_cut_off <= to_leg[0] && to_cut_off <= to_leg[1] {
            return Some(self.off_line(0, -edge, source));
        }
        let side = usize::from(to_leg[1] < to_leg[0]);
        let leg = self.legs[side];
        let direction = if side == 0 { leg.direction } else { -leg.direction };
        (!leg.foreign).then(|| self.off_line(side, direction, source))
    }

    /// Tangent to the disc of radius r/τ about a cut-off corner.
    fn off_corner(&self, side: usize, from_corner: Vec2, source: HalfPlaneSource) -> HalfPlane {
        let outward = from_corner.normalize_or(-self.corners_mps[side].normalize_or(Vec2::X));
        HalfPlane::behind(self.corners_mps[side] + self.radius_mps * outward, -outward, source)
    }

    /// Parallel to a leg or to the cut-off line, at distance r/τ.
    fn off_line(&self, side: usize, direction: Vec2, source: HalfPlaneSource) -> HalfPlane {
        HalfPlane::new(self.corners_mps[side] + self.radius_mps * direction.perp(), direction, source)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::world::time_to_collision::disc_with_segment;

    const HORIZON_S: f32 = 2.0;
    const RADIUS_M: f32 = 0.3;

    /// A block, an L with a niche, and a thin wall beside them: corners of every kind.
    fn walls() -> Obstacles {
        let polygon = |corners: &[[f32; 2]]| corners.iter().copied().map(Vec2::from).collect::<Vec<Vec2>>();
        Obstacles::new(&[
            polygon(&[[1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [1.0, 1.0]]),
            polygon(&[[-3.0, -2.0], [-1.0, -2.0], [-1.0, -1.0], [-2.0, -1.0], [-2.0, 1.5], [-3.0, 1.5]]),
            polygon(&[[-1.0, 2.5], [2.0, 2.6], [2.0, 2.8]]),
        ])
    }

    fn half_planes(obstacles: &Obstacles, own: &Disc) -> Vec<HalfPlane> {
        let (mut near, mut found) = (Vec::new(), Vec::new());
        obstacles.near(own.position_m, 10.0, &mut near);
        wall_half_planes(obstacles, &near, own, HORIZON_S, &mut found);
        found
    }

    /// Time at which a disc meets a wall, s; its radius differs from [`RADIUS_M`] by a margin.
    fn met_s(obstacles: &Obstacles, position_m: Vec2, velocity_mps: Vec2, margin_m: f32) -> f32 {
        let edges = 0..obstacles.corners().len() as u32;
        let met_s = |edge| {
            let corners_m = obstacles.ends_m(edge).map(|end_m| end_m - position_m);
            disc_with_segment(corners_m, velocity_mps, RADIUS_M + margin_m)
        };
        edges.map(met_s).fold(f32::INFINITY, f32::min)
    }

    fn vector(bound: f32) -> impl Strategy<Value = Vec2> {
        (-bound..bound, -bound..bound).prop_map(Vec2::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_permitted_velocity_meets_no_wall_within_the_horizon(
            position_m in vector(4.0), velocity_mps in vector(1.5), tried_mps in vector(2.0),
        ) {
            let obstacles = walls();
            if obstacles.depth_m(position_m, RADIUS_M + 0.01) > 0.0 {
                return Ok(());
            }
            let own = Disc { position_m, velocity_mps, radius_m: RADIUS_M };
            let found = half_planes(&obstacles, &own);
            prop_assert!(found.iter().all(|half_plane| half_plane.violation_mps(Vec2::ZERO) < 1e-4), "standing is forbidden");
            let permitted = found.iter().all(|half_plane| half_plane.violation_mps(tried_mps) <= 0.0);
            prop_assert!(!permitted || met_s(&obstacles, position_m, tried_mps, -2e-3) > HORIZON_S - 1e-2);
        }

        #[test]
        fn a_velocity_that_meets_no_wall_is_permitted(position_m in vector(4.0), velocity_mps in vector(1.5)) {
            let obstacles = Obstacles::new(&[vec![Vec2::new(1.0, -1.0), Vec2::new(2.0, -1.0), Vec2::new(1.5, 1.0)]]);
            if obstacles.depth_m(position_m, RADIUS_M + 0.01) > 0.0 {
                return Ok(());
            }
            let own = Disc { position_m, velocity_mps, radius_m: RADIUS_M };
            let kept = half_planes(&obstacles, &own).iter().all(|half_plane| half_plane.violation_mps(velocity_mps) <= 1e-3);
            prop_assert!(kept || met_s(&obstacles, position_m, velocity_mps, 4e-3) < HORIZON_S + 2e-2);
        }
    }

    #[test]
    fn a_disc_in_contact_may_leave_and_slide_only() {
        let own = Disc { position_m: Vec2::new(0.75, 0.0), velocity_mps: Vec2::ZERO, radius_m: RADIUS_M };
        let found = half_planes(&walls(), &own);
        let permits = |velocity_mps| found.iter().all(|half_plane| half_plane.violation_mps(velocity_mps) <= 1e-6);
        assert!(permits(-0.2 * Vec2::X) && permits(0.2 * Vec2::Y) && !permits(0.1 * Vec2::X));
    }
}

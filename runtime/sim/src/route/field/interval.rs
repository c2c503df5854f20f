//! What a root sees through an edge, and whether an end of the edge offers shorter routes.
//!
//! A *root* is a point at which routes turn, or from which they start: a vertex of the mesh, or a source. A *cone* is
//! the set of points that a root sees between two rays. Each ray is kept as a pair of points, never as a computed
//! direction, so that a point on it is known to be on it. World, metres.

use glam::DVec2;

use crate::route::mesh::locate::nearest_on_edge;

/// A ray that does not limit a cone.
pub(crate) const NO_RAY: u32 = u32::MAX;
/// The line across the heading of zone 0 that limits a cone of a root in that zone: agents come to the root from behind
/// it. Zone k has this number less k.
pub(crate) const LEVEL_RAY: u32 = u32::MAX - 2;
/// Greatest number of one-way zones, so that no vertex has the number of a ray.
const ZONES_MAX: u32 = 1 << 16;
/// Twice the area by which a point may lie outside a cone and still be seen, m²: rounding of f64 at 16 km.
pub(crate) const OUTSIDE_M2: f64 = 1e-7;
/// Length by which a route must be longer than another one to be dropped, m: more than all rounding.
const LONGER_M: f64 = 1e-9;

/// The zone whose line across limits a cone on a ray; none of other rays.
pub(crate) fn level_zone(ray: u32) -> Option<u32> {
    let zone = LEVEL_RAY.wrapping_sub(ray);
    (zone < ZONES_MAX).then_some(zone)
}

/// A cone of a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cone {
    /// Index of the root.
    pub(crate) root: u32,
    /// Index of a point on the left ray; [`NO_RAY`] where nothing limits the cone. The root itself stands for the ray
    /// on which the route came to the root, continued.
    pub(crate) left: u32,
    /// The same of the right ray.
    pub(crate) right: u32,
}

/// The stretch of an edge that a cone covers, seen from its root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Position of the root, m.
    pub(crate) root_m: DVec2,
    /// Distance of the root from the source, along the route, m.
    pub(crate) distance_m: f64,
    /// Both ends of the edge, the left one first, m.
    pub(crate) edge_m: [DVec2; 2],
    /// Both ends of the stretch, the left one first, m.
    pub(crate) ends_m: [DVec2; 2],
}

impl Span {
    /// Least length of the routes to points of the stretch, m.
    pub(crate) fn least_m(&self) -> f64 {
        let [left_m, right_m] = self.ends_m;
        self.distance_m + nearest_on_edge(self.root_m, left_m, right_m).distance(self.root_m)
    }

    /// Least length of the routes through the stretch to a target, m: straight, or over the end nearer to the straight
    /// line. A target on this side of the edge is mirrored.
    pub(crate) fn least_to_m(&self, target_m: DVec2) -> f64 {
        let [left_m, right_m] = self.edge_m;
        let (along_m, offset_m) = (right_m - left_m, target_m - left_m);
        // The root lies to the right of the edge from its left end to its right end.
        let across_m2 = along_m.perp_dot(offset_m).min(0.0);
        let target_m = target_m - 2.0 * across_m2 / along_m.length_squared() * along_m.perp();
        let towards_m = target_m - self.root_m;
        let over = |end_m: DVec2| end_m.distance(self.root_m) + end_m.distance(target_m);
        let [left_m, right_m] = self.ends_m;
        let beyond_m = if (left_m - self.root_m).perp_dot(towards_m) > 0.0 {
            over(left_m)
        } else if (right_m - self.root_m).perp_dot(towards_m) < 0.0 {
            over(right_m)
        } else {
            towards_m.length()
        };
        self.distance_m + beyond_m
    }

    /// Whether every point of the stretch has a shorter route over the left or the right end of the edge, given lengths
    /// of routes to these ends, m.
    ///
    /// Along the edge, away from an end, the detour over that end never becomes longer. So the far end of the stretch
    /// decides (the filter of Xin and Wang 2009 for geodesics).
    pub(crate) fn is_dominated(&self, lengths_m: [f64; 2]) -> bool {
        let detours = [(0, self.ends_m[1]), (1, self.ends_m[0])];
        detours.into_iter().any(|(end, far_m)| {
            let direct_m = self.distance_m + self.root_m.distance(far_m) - LONGER_M;
            lengths_m[end] < direct_m && lengths_m[end] + self.edge_m[end].distance(far_m) < direct_m
        })
    }
}

/// The point at which a ray meets an edge, given the ray's origin and direction; an end of the edge where it does not.
pub(crate) fn meeting_point_m(origin_m: DVec2, direction_m: DVec2, [left_m, right_m]: [DVec2; 2]) -> DVec2 {
    let [left, right] = [left_m, right_m].map(|end_m| direction_m.perp_dot(end_m - origin_m));
    let share = if left > right { left / (left - right) } else { 0.0 };
    left_m.lerp(right_m, share.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;

    fn span(random: &mut SplitMix64) -> Span {
        let mut within = |reach_m| random.within(reach_m);
        let edge_m =
            [DVec2::new(-1.0 + 0.5 * within(1.0), within(0.5)), DVec2::new(1.0 + 0.5 * within(1.0), within(0.5))];
        let [first, second] = [within(0.5) + 0.5, within(0.5) + 0.5];
        let ends_m = [first.min(second), first.max(second)].map(|share| edge_m[0].lerp(edge_m[1], share));
        Span { root_m: DVec2::new(within(4.0), -2.0 + within(1.0)), distance_m: 1.0, edge_m, ends_m }
    }

    fn stretch(span: Span) -> impl Iterator<Item = DVec2> {
        (0..=400).map(move |step| span.ends_m[0].lerp(span.ends_m[1], f64::from(step) / 400.0))
    }

    #[test]
    fn least_lengths_are_those_of_many_points() {
        let mut random = SplitMix64::new(3, 0);
        for _ in 0..300 {
            let span = span(&mut random);
            let target_m = DVec2::new(random.within(5.0), random.within(5.0));
            let near = |point_m: DVec2| span.distance_m + span.root_m.distance(point_m);
            let near_m = stretch(span).map(near).fold(f64::INFINITY, f64::min);
            let through_m =
                stretch(span).map(|at_m| near(at_m) + at_m.distance(target_m)).fold(f64::INFINITY, f64::min);
            assert!((near_m - span.least_m()).abs() < 1e-3 && span.least_m() <= near_m + 1e-12);
            assert!(
                (through_m - span.least_to_m(target_m)).abs() < 1e-3 && span.least_to_m(target_m) <= through_m + 1e-12
            );
        }
    }

    #[test]
    fn a_dominated_stretch_has_a_shorter_route_to_every_point() {
        let (mut random, mut dominated) = (SplitMix64::new(5, 0), 0);
        for _ in 0..2000 {
            let span = span(&mut random);
            let lengths_m = [2.0 + random.within(2.0), 2.0 + random.within(2.0)];
            if span.is_dominated(lengths_m) {
                dominated += 1;
                for point_m in stretch(span) {
                    let over = |end: usize| lengths_m[end] + span.edge_m[end].distance(point_m);
                    assert!(over(0).min(over(1)) < span.distance_m + span.root_m.distance(point_m));
                }
            }
        }
        assert!((100..1900).contains(&dominated), "{dominated}");
    }
}

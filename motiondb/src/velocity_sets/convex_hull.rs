//! Convex hull of velocities (`FbCrowd` §4.1), by Andrew's monotone chain (1979) on exact predicates.

use glam::Vec2;
use robust::{Coord, orient2d};

/// Corners of the convex hull of the points and the origin, clockwise; collinear points are removed.
pub(crate) fn clockwise_hull(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut sorted: Vec<Vec2> = points.chain([Vec2::ZERO]).collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half_hull(sorted.iter().copied());
    hull.extend(half_hull(sorted.iter().rev().copied()));
    hull
}

/// Upper or lower half of the hull: the chain that turns right at every corner; its last point is left to the other
/// half.
fn half_hull(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut chain: Vec<Vec2> = Vec::new();
    for point in points {
        while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) >= 0.0 {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

/// Positive if a, b, c turn left. The sign is exact.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let coord = |point: Vec2| Coord { x: f64::from(point.x), y: f64::from(point.y) };
    orient2d(coord(a), coord(b), coord(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn hulls_are_clockwise_and_hold_every_point(points in prop::collection::vec((-40i8..40, -40i8..40), 0..40)) {
            let points: Vec<Vec2> = points.iter().map(|&(x, y)| Vec2::new(f32::from(x), f32::from(y)) / 16.0).collect();
            let hull = clockwise_hull(points.iter().copied());
            let corner = |k: usize| hull[k % hull.len()];
            for k in 0..hull.len() {
                prop_assert!(hull.len() < 3 || turn(corner(k), corner(k + 1), corner(k + 2)) < 0.0);
                for &point in points.iter().chain(&[Vec2::ZERO]) {
                    prop_assert!(turn(corner(k), corner(k + 1), point) <= 0.0);
                }
            }
        }
    }

    #[test]
    fn straight_walks_have_a_hull_without_area() {
        let points = [Vec2::new(0.8, 0.0), Vec2::new(1.4, 0.0)];
        assert_eq!(clockwise_hull(points.iter().copied()), vec![Vec2::ZERO, Vec2::new(1.4, 0.0)]);
    }
}

//! The velocity sets of a database (`FbCrowd` §4.1, Eqs. 2–5; `definitions.md`, "Velocity constraints").
//!
//! All polygons are in the agent's frame (x forward, y left, m/s), clockwise, and count the origin: standing is always
//! possible.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, Vec2};
use motiondb::motion_db::MotionExample;
use motiondb::velocity_hull::{Construction, VelocityHull, is_holding, is_turning, turning_point_mps};
use robust::{Coord, orient2d};

/// Directions closer than this are one direction of the wrapping polygon: what gait noise leaves in a turn rate (3 °/s,
/// as for snapping).
const SAME_DIRECTION_RAD: f64 = 3.0 * TAU / 360.0;
/// A point this near the origin has no direction: a body that stands, m/s.
const STANDING_MPS: f64 = 1e-3;

/// Both sets and the sharp-turn edges of a database's examples.
pub fn build(examples: &[MotionExample], construction: Construction) -> VelocityHull {
    let parameters = || examples.iter().map(|example| &example.parameters);
    let turning: Vec<Vec2> = parameters().filter(|found| is_turning(found)).map(turning_point_mps).collect();
    let holding =
        parameters().filter(|found| is_holding(found)).map(|found| Vec2::new(found.speed_mps, found.strafe_mps));
    let turning_mps = clockwise_hull(turning.iter().copied());
    VelocityHull {
        construction,
        holding_mps: match construction {
            Construction::TurningAndHolding => clockwise_hull(holding),
            Construction::Paper => turning_mps.clone(),
        },
        turning_mps,
        sharp_turn_edges_mps: sharp_turn_edges(&wrapping_polygon(&turning)),
    }
}

/// Convex hull of the points and the origin, clockwise, without corners on its edges (Andrew's monotone chain on exact
/// predicates).
pub fn clockwise_hull(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
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

/// The chain from the first point to before the last that turns right at every corner.
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

/// Positive where a, b, c turn left; its sign is exact.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let coord = |point: Vec2| Coord { x: f64::from(point.x), y: f64::from(point.y) };
    orient2d(coord(a), coord(b), coord(c))
}

/// The outermost point per direction, clockwise from straight behind: a polygon that is star-shaped about the origin.
pub fn wrapping_polygon(points: &[Vec2]) -> Vec<Vec2> {
    let mut sorted: Vec<(f64, Vec2)> = points
        .iter()
        .filter(|point| f64::from(point.length()) > STANDING_MPS)
        .map(|&point| (libm::atan2(f64::from(point.y), f64::from(point.x)), point))
        .collect();
    sorted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.length().total_cmp(&b.1.length())));
    let mut polygon: Vec<(f64, Vec2)> = Vec::new();
    for (angle, point) in sorted {
        match polygon.last_mut() {
            Some((last, outermost)) if *last - angle < SAME_DIRECTION_RAD => {
                if point.length() > outermost.length() {
                    (*last, *outermost) = (angle, point);
                }
            }
            _ => polygon.push((angle, point)),
        }
    }
    polygon.into_iter().map(|(_, point)| point).collect()
}

/// Edges of the wrapping polygon with an end beyond ±90° (the red lines of Fig. 3b). An edge that passes behind the
/// origin bounds nothing.
fn sharp_turn_edges(polygon: &[Vec2]) -> Vec<[Vec2; 2]> {
    if polygon.len() < 2 {
        return Vec::new();
    }
    let behind = |point: Vec2| DVec2::X.angle_to(point.as_dvec2()).abs() > FRAC_PI_2;
    let edges = (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]);
    edges.filter(|[from, to]| (behind(*from) || behind(*to)) && turn(*from, *to, Vec2::ZERO) < 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_hull_is_clockwise_and_holds_every_point(points in prop::collection::vec((-40i8..40, -40i8..40), 0..40)) {
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
    fn the_wrapping_polygon_keeps_the_fastest_of_each_direction_and_its_rear_edges_are_sharp_turns() {
        let at = |speed: f32, degrees: f32| Vec2::from_angle(degrees.to_radians()) * speed;
        let mut points = vec![at(1.1, 0.0), at(3.9, 0.0), Vec2::ZERO];
        for (speed, degrees) in [(0.8, 46.0), (2.3, 79.0), (0.5, 97.0), (1.7, 150.0), (0.2, 168.0)] {
            points.extend([at(speed, degrees), at(speed, -degrees)]);
        }
        let polygon = wrapping_polygon(&points);
        assert_eq!(polygon.len(), 11);
        assert!(polygon.contains(&at(3.9, 0.0)) && !polygon.contains(&at(1.1, 0.0)));
        // 79→97, 97→150, 150→168 on each side, and 168→−168 behind.
        assert_eq!(sharp_turn_edges(&polygon).len(), 7);
    }

    #[test]
    fn straight_walks_alone_have_no_sharp_turns() {
        let points = [Vec2::new(0.8, 0.0), Vec2::new(1.4, 0.0)];
        assert_eq!(clockwise_hull(points.iter().copied()), vec![Vec2::ZERO, Vec2::new(1.4, 0.0)]);
        assert!(sharp_turn_edges(&wrapping_polygon(&points)).is_empty());
    }
}

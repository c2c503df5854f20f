//! The wrapping polygon of the turning examples and its sharp-turn edges (`FbCrowd` §4.1, Fig. 3b).
//!
//! The convex hull of the turning set also permits velocities behind the body that no example has. The wrapping
//! polygon, which is star-shaped about the origin, does not. Agent's frame (x forward, y left), m/s.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, Vec2};

/// Angle up to which two directions are one, rad: gait noise in a turn rate, 3 °/s, as in the compiler's snapping.
const SAME_DIRECTION_RAD: f64 = 3.0 * TAU / 360.0;
/// Speed up to which a point has no direction, m/s: a standing body.
const STANDING_MPS: f64 = 1e-3;

/// The outermost point per direction, clockwise from straight behind: a polygon that is star-shaped about the origin.
///
/// Points are taken from the farthest to the nearest; each counts if no farther one has its direction. So the result
/// does not depend on a first side or on the seam behind: a mirrored set has the mirrored polygon.
fn wrapping_polygon(points: &[Vec2]) -> Vec<Vec2> {
    let mut directed: Vec<(f64, Vec2)> = points
        .iter()
        .filter(|point| f64::from(point.length()) > STANDING_MPS)
        .map(|&point| (libm::atan2(f64::from(point.y), f64::from(point.x)), point))
        .collect();
    directed.sort_by(|a, b| b.1.length().total_cmp(&a.1.length()).then(b.0.total_cmp(&a.0)));
    let mut outermost: Vec<(f64, Vec2)> = Vec::new();
    for (angle, point) in directed {
        let hides = |(other_angle, other): &(f64, Vec2)| {
            *other == point || (apart_rad(*other_angle, angle) < SAME_DIRECTION_RAD && other.length() > point.length())
        };
        if !outermost.iter().any(hides) {
            outermost.push((angle, point));
        }
    }
    outermost.sort_by(|a, b| b.0.total_cmp(&a.0));
    outermost.into_iter().map(|(_, point)| point).collect()
}

/// Smaller angle between two directions, rad.
fn apart_rad(one_rad: f64, other_rad: f64) -> f64 {
    let apart_rad = (one_rad - other_rad).abs();
    apart_rad.min(TAU - apart_rad)
}

/// Edges of the turning points' wrapping polygon with an end beyond ±90° (the red lines of Fig. 3b), each clockwise.
/// Edges with the origin on their outside are left out: they bound nothing.
pub(crate) fn sharp_turn_edges(turning_points_mps: &[Vec2]) -> Vec<[Vec2; 2]> {
    let polygon = wrapping_polygon(turning_points_mps);
    if polygon.len() < 2 {
        return Vec::new();
    }
    let behind = |point: Vec2| DVec2::X.angle_to(point.as_dvec2()).abs() > FRAC_PI_2;
    let edges = (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]]);
    let holds_the_origin = |[from, to]: &[Vec2; 2]| from.as_dvec2().perp_dot(to.as_dvec2()) < 0.0;
    edges.filter(|edge| edge.iter().any(|end| behind(*end)) && holds_the_origin(edge)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_fastest_point_per_direction_is_kept() {
        let at = |speed: f32, degrees: f32| Vec2::from_angle(degrees.to_radians()) * speed;
        let mut points = vec![at(1.1, 0.0), at(3.9, 0.0), Vec2::ZERO];
        for (speed, degrees) in [(0.8, 46.0), (2.3, 79.0), (0.5, 97.0), (1.7, 150.0), (0.2, 168.0)] {
            points.extend([at(speed, degrees), at(speed, -degrees)]);
        }
        let polygon = wrapping_polygon(&points);
        assert_eq!(polygon.len(), 11);
        assert!(polygon.contains(&at(3.9, 0.0)) && !polygon.contains(&at(1.1, 0.0)));
        // 79→97, 97→150, 150→168 on each side, and 168→−168 behind.
        assert_eq!(sharp_turn_edges(&points).len(), 7);
    }

    proptest! {
        #[test]
        fn mirrored_turns_have_mirrored_edges(
            turns in prop::collection::vec((1u8..40, 60i16..180), 1..12),
        ) {
            let at = |&(speed, degrees): &(u8, i16)| Vec2::from_angle(f32::from(degrees).to_radians()) * f32::from(speed);
            let left: Vec<Vec2> = turns.iter().map(at).collect();
            let across = |point: &Vec2| Vec2::new(point.x, -point.y);
            let both: Vec<Vec2> = left.iter().copied().chain(left.iter().map(across)).collect();
            let polygon = wrapping_polygon(&both);
            prop_assert!(polygon.iter().all(|point| polygon.contains(&across(point))), "{polygon:?}");
        }
    }

    #[test]
    fn straight_behind_is_one_direction() {
        let at = |speed: f32, degrees: f32| Vec2::from_angle(degrees.to_radians()) * speed;
        let points = [at(1.0, 90.0), at(0.2, 179.5), at(1.0, -179.5), at(1.0, -90.0)];
        assert_eq!(wrapping_polygon(&points), [points[0], points[3], points[2]]);
    }
}

//! Area, simplicity and containment of polygons. Corners are f32; signs are decided in f64, whose products of
//! differences are exact enough.
//!
//! World frame, metres.

use glam::{DVec2, Vec2};

/// Shoelace formula: positive where the corners run counter-clockwise, m².
pub(crate) fn signed_area_m2(corners_m: &[Vec2]) -> f64 {
    0.5 * edges(corners_m).map(|[a, b]| a.perp_dot(b)).sum::<f64>()
}

/// Whether edges touch only at common corners.
pub(crate) fn is_simple(corners_m: &[Vec2]) -> bool {
    self_contact_m(corners_m).is_none()
}

/// The first position at which edges touch elsewhere than at common corners, m.
pub(crate) fn self_contact_m(corners_m: &[Vec2]) -> Option<DVec2> {
    let edges: Vec<[DVec2; 2]> = edges(corners_m).collect();
    let count = edges.len();
    (0..count).find_map(|i| {
        let [before, at] = edges[i];
        let [_, after] = edges[(i + 1) % count];
        let folds_back = side(before, at, after) == 0.0 && (before - at).dot(after - at) >= 0.0;
        let mut others = (i + 2..count).filter(|&j| (j + 1) % count != i);
        folds_back.then_some(at).or_else(|| others.find_map(|j| contact_m(edges[i], edges[j])))
    })
}

/// Whether a point lies inside, by the even–odd rule; a point on an edge counts as either.
pub fn contains(corners_m: &[Vec2], point_m: Vec2) -> bool {
    let point = DVec2::from(point_m);
    let crossings = edges(corners_m)
        .filter(|&[a, b]| (a.y > point.y) != (b.y > point.y) && (side(a, b, point) > 0.0) == (b.y > a.y));
    crossings.count() % 2 == 1
}

/// Distance from a point to the nearest edge, m.
pub(crate) fn closest_distance_m(corners_m: &[Vec2], point_m: Vec2) -> f64 {
    let point = DVec2::from(point_m);
    let distance = |[a, b]: [DVec2; 2]| {
        let share = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        point.distance(a.lerp(b, share))
    };
    edges(corners_m).map(distance).fold(f64::INFINITY, f64::min)
}

fn edges(corners_m: &[Vec2]) -> impl Iterator<Item = [DVec2; 2]> {
    let ends = corners_m.iter().cycle().skip(1);
    corners_m.iter().zip(ends).map(|(a, b)| [DVec2::from(*a), DVec2::from(*b)])
}

/// Positive if c lies left of the line from a to b.
fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// A common point of two segments, m: each crosses the line of the other, or an end lies on the other segment.
fn contact_m([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let (of_a, of_b) = (side(c, d, a), side(c, d, b));
    if side(a, b, c) * side(a, b, d) < 0.0 && of_a * of_b < 0.0 {
        return Some(a.lerp(b, of_a / (of_a - of_b)));
    }
    let on = |a: DVec2, b: DVec2, c: DVec2| side(a, b, c) == 0.0 && (a - c).dot(b - c) <= 0.0;
    let ends = [(on(a, b, c), c), (on(a, b, d), d), (on(c, d, a), a), (on(c, d, b), b)];
    ends.into_iter().find_map(|(is_on, end)| is_on.then_some(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vec2; 4] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];

    fn check_simple(corners: &[[f32; 2]], expected: bool) {
        let corners: Vec<Vec2> = corners.iter().copied().map(Vec2::from).collect();
        assert_eq!(is_simple(&corners), expected, "{corners:?}");
    }

    #[test]
    fn bow_ties_spikes_and_pinched_polygons_are_not_simple() {
        check_simple(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], true);
        check_simple(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0]], true);
        check_simple(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], false);
        check_simple(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]], false);
        check_simple(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]], false);
        check_simple(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], false);
    }

    #[test]
    fn containment_does_not_depend_on_the_winding() {
        let clockwise: Vec<Vec2> = SQUARE.into_iter().rev().collect();
        assert_eq!((signed_area_m2(&SQUARE), signed_area_m2(&clockwise)), (1.0, -1.0));
        for corners in [&SQUARE[..], &clockwise] {
            assert!(contains(corners, Vec2::splat(0.3)) && !contains(corners, Vec2::new(1.2, 0.3)));
            assert!(!contains(corners, Vec2::new(-0.2, 1.0)));
        }
    }

    #[test]
    fn distances_are_to_edges_and_corners() {
        assert_eq!(closest_distance_m(&SQUARE, Vec2::new(0.5, 1.5)), 0.5);
        assert_eq!(closest_distance_m(&SQUARE, Vec2::new(4.0, 5.0)), 5.0);
        assert!((closest_distance_m(&SQUARE, Vec2::new(0.5, 0.3)) - 0.3).abs() < 1e-6);
    }
}

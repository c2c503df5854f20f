//! Polygons: corners in order, the first not repeated. World, metres.

use crate::scene::Point;

/// Greatest number of corners of a polygon: the test for crossings compares every pair of edges.
pub(crate) const CORNERS_MAX: usize = 5_000;
/// Distance within which two corners are one, m.
const SAME_M: f64 = 1e-6;

/// The corners without repeated ones.
pub(crate) fn without_repeats(corners_m: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::with_capacity(corners_m.len());
    for &corner_m in corners_m {
        if kept.last().is_none_or(|last_m| distance_m(*last_m, corner_m) > SAME_M) {
            kept.push(corner_m);
        }
    }
    while kept.len() > 1 && distance_m(kept[0], kept[kept.len() - 1]) <= SAME_M {
        kept.pop();
    }
    kept
}

/// Area, m²; positive where the corners run counter-clockwise.
pub(crate) fn signed_area_m2(corners_m: &[Point]) -> f64 {
    let origin = corners_m.first().copied().unwrap_or_default();
    let twice: f64 = edges(corners_m).map(|(a, b)| cross(sub(a, origin), sub(b, origin))).sum();
    0.5 * twice
}

/// Whether no edge crosses or touches another, beyond the corner that neighbours share.
pub(crate) fn is_simple(corners_m: &[Point]) -> bool {
    let count = corners_m.len();
    if !(3..=CORNERS_MAX).contains(&count) {
        return false;
    }
    let all: Vec<(Point, Point)> = edges(corners_m).collect();
    for (index, &(a, b)) in all.iter().enumerate() {
        // An edge that runs back along its neighbour.
        let next = all[(index + 1) % count].1;
        if cross(sub(b, a), sub(next, b)) == 0.0 && dot(sub(b, a), sub(next, b)) < 0.0 {
            return false;
        }
        let last = if index == 0 { count - 1 } else { count };
        if all[(index + 2).min(last)..last].iter().any(|&(c, d)| touch(a, b, c, d)) {
            return false;
        }
    }
    true
}

/// Whether a point lies inside.
pub(crate) fn contains(corners_m: &[Point], at_m: Point) -> bool {
    let crosses = |&(a, b): &(Point, Point)| {
        (a[1] > at_m[1]) != (b[1] > at_m[1]) && at_m[0] < a[0] + (at_m[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    edges(corners_m).filter(crosses).count() % 2 == 1
}

/// Distance from a point to the nearest edge, m.
pub(crate) fn edge_distance_m(corners_m: &[Point], at_m: Point) -> f64 {
    edges(corners_m).map(|(a, b)| segment_distance_m(a, b, at_m)).fold(f64::INFINITY, f64::min)
}

/// Least and greatest corner.
pub(crate) fn bounds_m(corners_m: &[Point]) -> [Point; 2] {
    let by = |start: f64, pick: fn(f64, f64) -> f64, axis: usize| {
        corners_m.iter().map(|corner_m| corner_m[axis]).fold(start, pick)
    };
    [[0, 1].map(|axis| by(f64::INFINITY, f64::min, axis)), [0, 1].map(|axis| by(f64::NEG_INFINITY, f64::max, axis))]
}

/// The edges in order.
pub(crate) fn edges(corners_m: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    corners_m.iter().copied().zip(corners_m.iter().copied().cycle().skip(1))
}

/// Distance between two points, m.
pub(crate) fn distance_m(a: Point, b: Point) -> f64 {
    dot(sub(a, b), sub(a, b)).sqrt()
}

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn segment_distance_m(a: Point, b: Point, at_m: Point) -> f64 {
    let along = sub(b, a);
    let length2 = dot(along, along);
    let share = if length2 > 0.0 { (dot(sub(at_m, a), along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    distance_m(at_m, [a[0] + share * along[0], a[1] + share * along[1]])
}

/// Whether two segments share a point.
fn touch(a: Point, b: Point, c: Point, d: Point) -> bool {
    let overlaps =
        |axis: usize| a[axis].min(b[axis]) <= c[axis].max(d[axis]) && c[axis].min(d[axis]) <= a[axis].max(b[axis]);
    let sides = |from: Point, to: Point, p: Point, q: Point| {
        let [p, q] = [p, q].map(|point| cross(sub(to, from), sub(point, from)));
        p == 0.0 || q == 0.0 || (p > 0.0) != (q > 0.0)
    };
    overlaps(0) && overlaps(1) && sides(a, b, c, d) && sides(c, d, a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_and_touches_are_found() {
        let check = |corners_m: &[Point], is: bool| assert_eq!(is_simple(corners_m), is, "{corners_m:?}");
        check(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], true);
        check(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], true);
        check(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], false);
        check(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], false);
        check(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 0.0], [0.0, 2.0]], false);
    }

    #[test]
    fn a_point_is_inside_or_not() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert!(contains(&square, [1.0, 1.0]) && !contains(&square, [3.0, 1.0]));
        assert!((edge_distance_m(&square, [1.0, 0.5]) - 0.5).abs() < 1e-12);
        assert!((signed_area_m2(&square) - 4.0).abs() < 1e-12);
    }
}

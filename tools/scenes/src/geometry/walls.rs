//! Walls without thickness: each edge becomes a thin rectangle. World, metres.

use crate::geometry::polygon::{distance_m, sub};
use crate::scene::Point;

/// Thickness of a wall that a source draws as a line, m.
pub(crate) const THICKNESS_M: f64 = 0.02;

/// A rectangle about each edge of a line.
pub(crate) fn of_line(line_m: &[Point], is_closed: bool) -> Vec<Vec<Point>> {
    let closing = line_m.last().zip(line_m.first()).filter(|_| is_closed && line_m.len() > 2);
    let open = line_m.iter().zip(line_m.iter().skip(1));
    open.chain(closing).filter_map(|(&a, &b)| of_edge(a, b)).collect()
}

fn of_edge(a: Point, b: Point) -> Option<Vec<Point>> {
    let length_m = distance_m(a, b);
    if length_m < THICKNESS_M {
        return None;
    }
    let [x, y] = sub(b, a).map(|along| 0.5 * THICKNESS_M * along / length_m);
    // Longer by half the thickness at both ends, so that neighbours overlap.
    let corner = |at: Point, ahead: f64, aside: f64| {
        [at[0] + ahead * x - aside * y, at[1] + ahead * y + aside * x].map(|metres| (metres * 1e4).round() / 1e4)
    };
    Some(vec![corner(a, -1.0, -1.0), corner(b, 1.0, -1.0), corner(b, 1.0, 1.0), corner(a, -1.0, 1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::{is_simple, signed_area_m2};

    #[test]
    fn each_edge_becomes_a_rectangle() {
        let line_m = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]];
        assert_eq!(of_line(&line_m, false).len(), 2);
        let closed = of_line(&line_m, true);
        assert_eq!(closed.len(), 3);
        for wall_m in closed {
            assert!(is_simple(&wall_m) && signed_area_m2(&wall_m) > 0.05, "{wall_m:?}");
        }
    }
}

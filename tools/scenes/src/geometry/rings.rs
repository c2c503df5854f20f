//! Rings: closed outlines, and which of them are holes of which. World, metres.

use std::collections::BTreeMap;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use crate::geometry::polygon::{contains, cross, signed_area_m2, sub};
use crate::scene::{Point, Walkable};

/// Lines per metre of the grid on which polygons are united: 10 km fit into 32 bits.
const LINES_PER_M: f64 = 1e5;

/// Closed outlines of directed edges between numbered vertices; edges that do not close are left out.
///
/// Where outlines meet in a vertex, each turns left as sharply as it can, so that none crosses itself.
pub(crate) fn closed_rings(vertices_m: &[Point], edges: &[(usize, usize)]) -> Vec<Vec<Point>> {
    let mut leaving: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &(from, to) in edges {
        leaving.entry(from).or_default().push(to);
    }
    let mut rings = Vec::new();
    for &(start, first) in edges {
        let Some(next) = take(&mut leaving, start, |to| to == first) else { continue };
        let mut ring = vec![start];
        let (mut before, mut at) = (start, next);
        while at != start {
            ring.push(at);
            let ahead = sub(vertices_m[at], vertices_m[before]);
            let Some(to) = sharpest_left(vertices_m, leaving.get(&at).map_or(&[], Vec::as_slice), at, ahead) else {
                break;
            };
            take(&mut leaving, at, |other| other == to);
            (before, at) = (at, to);
        }
        if at == start && ring.len() > 2 {
            rings.push(ring.into_iter().map(|vertex| vertices_m[vertex]).collect());
        }
    }
    rings
}

fn take(leaving: &mut BTreeMap<usize, Vec<usize>>, from: usize, is: impl Fn(usize) -> bool) -> Option<usize> {
    let targets = leaving.get_mut(&from)?;
    let index = targets.iter().position(|&to| is(to))?;
    Some(targets.swap_remove(index))
}

fn sharpest_left(vertices_m: &[Point], targets: &[usize], at: usize, ahead: Point) -> Option<usize> {
    let turn = |to: usize| {
        let next = sub(vertices_m[to], vertices_m[at]);
        libm::atan2(cross(ahead, next), ahead[0] * next[0] + ahead[1] * next[1])
    };
    targets.iter().copied().max_by(|a, b| turn(*a).total_cmp(&turn(*b)))
}

/// The outlines of all ground that convex polygons cover, to 10 µm; clockwise ones are holes.
pub(crate) fn united(polygons_m: &[Vec<Point>]) -> Vec<Vec<Point>> {
    let to_grid = |metres: f64| (metres * LINES_PER_M).round() as i32;
    let mut overlay = Overlay::<i32>::new(polygons_m.iter().map(Vec::len).sum());
    for polygon_m in polygons_m {
        let is_clockwise = signed_area_m2(polygon_m) < 0.0;
        let mut contour: Vec<_> = polygon_m.iter().map(|&[x, y]| IntPoint::new(to_grid(x), to_grid(y))).collect();
        if is_clockwise {
            contour.reverse();
        }
        overlay.add_contour(&contour, ShapeType::Subject);
    }
    let contours = overlay.overlay(OverlayRule::Subject, FillRule::NonZero).into_iter().flatten();
    let metres = |line: i32| f64::from(line) / LINES_PER_M;
    let ring_m = |contour: Vec<IntPoint<i32>>| contour.iter().map(|at| [metres(at.x), metres(at.y)]).collect();
    contours.map(ring_m).flat_map(|ring_m: Vec<Point>| parted(&ring_m)).collect()
}

/// The loops of a ring that touches itself in corners.
fn parted(ring_m: &[Point]) -> Vec<Vec<Point>> {
    let (mut loops, mut open_m) = (Vec::new(), Vec::<Point>::new());
    for &corner_m in ring_m {
        if let Some(begin) = open_m.iter().position(|other_m| *other_m == corner_m) {
            loops.push(open_m.split_off(begin));
        }
        open_m.push(corner_m);
    }
    loops.push(open_m);
    loops.retain(|ring_m| ring_m.len() > 2);
    loops
}

/// Outlines that run counter-clockwise, each with the clockwise ones that lie inside.
pub(crate) fn with_holes(rings: Vec<Vec<Point>>, origin: &str) -> Vec<Walkable> {
    let (outer, holes): (Vec<_>, Vec<_>) = rings.into_iter().partition(|ring| signed_area_m2(ring) > 0.0);
    let walkable = |polygon_m| Walkable { polygon_m, holes_m: Vec::new(), origin: origin.to_owned() };
    let mut all: Vec<Walkable> = outer.into_iter().map(walkable).collect();
    for hole_m in holes {
        let is_around = |walkable: &&mut Walkable| {
            let inside = hole_m.iter().filter(|corner_m| contains(&walkable.polygon_m, **corner_m)).count();
            2 * inside > hole_m.len()
        };
        let area_m2 = |walkable: &&mut Walkable| signed_area_m2(&walkable.polygon_m);
        if let Some(smallest) = all.iter_mut().filter(is_around).min_by(|a, b| area_m2(a).total_cmp(&area_m2(b))) {
            smallest.holes_m.push(hole_m);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_with_a_hole_is_found() {
        let square = |side: f64| [[-side, -side], [side, -side], [side, side], [-side, side]];
        let vertices_m = [square(3.0), square(1.0)].concat();
        let edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 7), (7, 6), (6, 5), (5, 4)];
        let rings = closed_rings(&vertices_m, &edges);
        assert_eq!(rings.len(), 2);
        let walkable = with_holes(rings, "x");
        assert_eq!((walkable.len(), walkable[0].holes_m.len()), (1, 1));
    }

    #[test]
    fn rings_that_meet_in_a_vertex_stay_apart() {
        // Two triangles that share vertex 0.
        let vertices_m = [[0.0, 0.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let edges = [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)];
        let rings = closed_rings(&vertices_m, &edges);
        assert_eq!(rings.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
    }

    #[test]
    fn united_polygons_keep_their_corners_and_part_where_they_touch() {
        let rect = |x: f64, y: f64| vec![[x, y], [x + 2.0, y], [x + 2.0, y + 1.0], [x, y + 1.0]];
        // Two overlap, the second clockwise; a third touches in a corner.
        let clockwise: Vec<Point> = rect(1.00001, 0.5).into_iter().rev().collect();
        let rings = united(&[rect(0.0, 0.0), clockwise, rect(-2.0, -1.0)]);
        let areas_m2: f64 = rings.iter().map(|ring| signed_area_m2(ring)).sum();
        assert!((areas_m2 - (6.0 - 0.99999 * 0.5)).abs() < 1e-9, "{areas_m2}");
        assert!(rings.iter().all(|ring| crate::geometry::polygon::is_simple(ring)), "{rings:?}");
        assert!(rings.iter().flatten().any(|corner_m| *corner_m == [1.00001, 1.5]), "{rings:?}");
    }

    #[test]
    fn an_open_chain_is_no_ring() {
        assert!(closed_rings(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], &[(0, 1), (1, 2)]).is_empty());
    }
}

//! Rings: closed outlines, and which of them are holes of which. World, metres.

use std::collections::BTreeMap;

use crate::geometry::polygon::{contains, cross, signed_area_m2, sub};
use crate::scene::{Point, Walkable};

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
    fn an_open_chain_is_no_ring() {
        assert!(closed_rings(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], &[(0, 1), (1, 2)]).is_empty());
    }
}

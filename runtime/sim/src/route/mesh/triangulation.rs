//! Constrained Delaunay triangulation of what lies within contours, by `spade`.
//!
//! The contours must not cross each other; they may touch. Inside and outside alternate across their edges; an edge that
//! two contours share separates two cells. Metres.

use glam::DVec2;
use spade::handles::{DirectedEdgeHandle, FixedFaceHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::route::polygons::error::RouteError;

/// No triangle: the edge is a border.
pub(crate) const NONE: u32 = u32::MAX;

/// Triangles that share edges.
#[derive(Debug, Default)]
pub(crate) struct TriangleSoup {
    /// Corners of the triangles.
    pub(crate) points_m: Vec<DVec2>,
    /// Corners of each triangle, counter-clockwise.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangle beyond each edge; edge k runs from corner k to the next one. [`NONE`] at a border.
    pub(crate) neighbours: Vec<[u32; 3]>,
}

/// Triangles in cells, which the edges of contours separate.
#[derive(Debug, Default)]
pub(crate) struct CellSoup {
    /// The triangles; every edge of a contour is a border.
    pub(crate) soup: TriangleSoup,
    /// The triangle beyond each edge, contours not counted. [`NONE`] outside all contours.
    pub(crate) beyond: Vec<[u32; 3]>,
    /// Index of the cell of each triangle.
    pub(crate) cells: Vec<u32>,
}

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// The triangles within contours.
///
/// # Errors
/// If edges cross.
pub(crate) fn triangulate(contours_m: &[Vec<DVec2>]) -> Result<TriangleSoup, RouteError> {
    let points_m = distinct(contours_m);
    if points_m.len() < 3 {
        return Ok(TriangleSoup::default());
    }
    let delaunay = delaunay(&points_m, edges(contours_m, &points_m))?;
    let (inside, mut slots, mut count) = (inside(&delaunay), vec![NONE; delaunay.num_all_faces()], 0);
    for face in delaunay.fixed_inner_faces().filter(|face| inside[face.index()]) {
        slots[face.index()] = count;
        count += 1;
    }
    let mut soup = TriangleSoup { points_m, ..TriangleSoup::default() };
    for face in delaunay.inner_faces().filter(|face| inside[face.fix().index()]) {
        let edges = face.adjacent_edges();
        soup.triangles.push(edges.map(|edge| edge.from().fix().index() as u32));
        soup.neighbours.push(edges.map(|edge| {
            let is_border = delaunay.is_constraint_edge(edge.as_undirected().fix());
            if is_border { NONE } else { slots[edge.rev().face().fix().index()] }
        }));
    }
    Ok(soup)
}

/// The corners of all contours, each once, by x and then y.
fn distinct(contours_m: &[Vec<DVec2>]) -> Vec<DVec2> {
    let mut points_m: Vec<DVec2> = contours_m.concat();
    points_m.sort_unstable_by(by_x_then_y);
    points_m.dedup();
    points_m
}

fn by_x_then_y(a: &DVec2, b: &DVec2) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// The edges of all contours as indices of their ends.
fn edges(contours_m: &[Vec<DVec2>], points_m: &[DVec2]) -> Vec<[usize; 2]> {
    let index = |point_m: &DVec2| points_m.partition_point(|other_m| by_x_then_y(other_m, point_m).is_lt());
    let edges_of = |contour_m: &Vec<DVec2>| -> Vec<[usize; 2]> {
        let corners: Vec<usize> = contour_m.iter().map(index).collect();
        (0..corners.len()).map(|corner| [corners[corner], corners[(corner + 1) % corners.len()]]).collect()
    };
    contours_m.iter().flat_map(edges_of).collect()
}

fn delaunay(points_m: &[DVec2], edges: Vec<[usize; 2]>) -> Result<Delaunay, RouteError> {
    let points = points_m.iter().map(|point_m| Point2::new(point_m.x, point_m.y)).collect();
    let mut crossing = 0;
    let delaunay = Delaunay::try_bulk_load_cdt(points, edges, |_| crossing += 1);
    match delaunay {
        Ok(delaunay) if crossing == 0 && delaunay.num_vertices() == points_m.len() => Ok(delaunay),
        _ => Err(RouteError::Triangulation { edges: crossing.max(1) }),
    }
}

/// Which faces lie inside: the outer face does not, and each constraint edge separates inside from outside.
fn inside(delaunay: &Delaunay) -> Vec<bool> {
    let mut inside: Vec<Option<bool>> = vec![None; delaunay.num_all_faces()];
    let beyond = |edge: DirectedEdgeHandle<_, _, _, _>| {
        let face: FixedFaceHandle<InnerTag> = edge.rev().face().fix().as_inner()?;
        Some((face, delaunay.is_constraint_edge(edge.as_undirected().fix())))
    };
    let mut open = Vec::new();
    for edge in delaunay.convex_hull() {
        let inward = if edge.face().is_outer() { edge } else { edge.rev() };
        open.extend(beyond(inward));
    }
    while let Some((face, is_inside)) = open.pop() {
        if inside[face.index()].replace(is_inside).is_some() {
            continue;
        }
        let neighbours = delaunay.face(face).adjacent_edges().into_iter().filter_map(beyond);
        let unknown = neighbours.filter(|(face, _)| inside[face.index()].is_none());
        open.extend(unknown.map(|(face, is_border)| (face, is_inside != is_border)));
    }
    inside.into_iter().map(|is_inside| is_inside == Some(true)).collect()
}

/// The triangles within contours, which may share edges: cells on both sides of a cut.
///
/// # Errors
/// If edges cross.
pub(crate) fn triangulate_cells(contours_m: &[Vec<DVec2>]) -> Result<CellSoup, RouteError> {
    let points_m = distinct(contours_m);
    if points_m.len() < 3 {
        return Ok(CellSoup::default());
    }
    let mut ends = edges(contours_m, &points_m);
    ends.iter_mut().for_each(|ends| ends.sort_unstable());
    ends.sort_unstable();
    ends.dedup();
    let delaunay = delaunay(&points_m, ends)?;
    let cell_of = cells(&delaunay, contours_m);
    let (mut slots, mut count) = (vec![NONE; cell_of.len()], 0);
    for face in delaunay.fixed_inner_faces().filter(|face| cell_of[face.index()] != NONE) {
        slots[face.index()] = count;
        count += 1;
    }
    let mut found = CellSoup { soup: TriangleSoup { points_m, ..TriangleSoup::default() }, ..CellSoup::default() };
    for face in delaunay.inner_faces().filter(|face| cell_of[face.fix().index()] != NONE) {
        let edges = face.adjacent_edges();
        let beyond = edges.map(|edge| slots[edge.rev().face().fix().index()]);
        let is_border = edges.map(|edge| delaunay.is_constraint_edge(edge.as_undirected().fix()));
        found.soup.triangles.push(edges.map(|edge| edge.from().fix().index() as u32));
        found.soup.neighbours.push([0, 1, 2].map(|edge| if is_border[edge] { NONE } else { beyond[edge] }));
        found.beyond.push(beyond);
        found.cells.push(cell_of[face.fix().index()]);
    }
    Ok(found)
}

/// The cell of each face; [`NONE`] outside all contours. A cell ends at the edges of contours; the parity of the edges
/// beside its largest face decides whether it lies inside.
fn cells(delaunay: &Delaunay, contours_m: &[Vec<DVec2>]) -> Vec<u32> {
    let mut cells = vec![NONE; delaunay.num_all_faces()];
    let mut is_known = vec![false; cells.len()];
    let mut count = 0;
    for first in delaunay.inner_faces() {
        if is_known[first.fix().index()] {
            continue;
        }
        is_known[first.fix().index()] = true;
        let (mut faces, mut at) = (vec![first], 0);
        while let Some(&face) = faces.get(at) {
            at += 1;
            for edge in face.adjacent_edges() {
                let beyond = edge.rev().face().as_inner();
                let free = beyond.filter(|_| !delaunay.is_constraint_edge(edge.as_undirected().fix()));
                let new = free.filter(|face| !std::mem::replace(&mut is_known[face.fix().index()], true));
                faces.extend(new);
            }
        }
        let corners_m = |face: usize| faces[face].positions().map(|at| DVec2::new(at.x, at.y));
        let area_m2 = |face: usize| {
            let [a_m, b_m, c_m] = corners_m(face);
            (b_m - a_m).perp_dot(c_m - a_m)
        };
        let largest = (0..faces.len()).max_by(|&a, &b| area_m2(a).total_cmp(&area_m2(b))).unwrap_or_default();
        if is_inside(corners_m(largest).into_iter().sum::<DVec2>() / 3.0, contours_m) {
            faces.iter().for_each(|face| cells[face.fix().index()] = count);
            count += 1;
        }
    }
    cells
}

/// Whether a point lies within an odd number of contours.
fn is_inside(point_m: DVec2, contours_m: &[Vec<DVec2>]) -> bool {
    let crosses = |&(a_m, b_m): &(&DVec2, &DVec2)| {
        let beside_m2 = (*b_m - *a_m).perp_dot(point_m - *a_m);
        (a_m.y > point_m.y) != (b_m.y > point_m.y) && (beside_m2 > 0.0) == (b_m.y > a_m.y)
    };
    let edges_m = contours_m.iter().flat_map(|contour_m| contour_m.iter().zip(contour_m.iter().cycle().skip(1)));
    edges_m.filter(crosses).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        [[low, low], [high, low], [high, high], [low, high]].map(DVec2::from).to_vec()
    }

    #[test]
    fn holes_and_islands_alternate() {
        let soup = triangulate(&[square(0.0, 9.0), square(1.0, 8.0), square(2.0, 7.0)]).expect("nested squares");
        let area = |[a, b, c]: &[u32; 3]| {
            let [a_m, b_m, c_m] = [a, b, c].map(|corner| soup.points_m[*corner as usize]);
            0.5 * (b_m - a_m).perp_dot(c_m - a_m)
        };
        assert!(soup.triangles.iter().all(|triangle| area(triangle) > 0.0));
        assert_eq!(soup.triangles.iter().map(area).sum::<f64>(), 81.0 - 49.0 + 25.0);
        for (triangle, neighbours) in soup.neighbours.iter().enumerate() {
            let mut inner = neighbours.iter().filter(|&&neighbour| neighbour != NONE);
            assert!(inner.all(|&neighbour| soup.neighbours[neighbour as usize].contains(&(triangle as u32))));
        }
    }

    #[test]
    fn crossing_contours_are_refused_and_none_are_empty() {
        let crossed = [square(0.0, 2.0), square(1.0, 3.0)];
        assert!(matches!(triangulate(&crossed), Err(RouteError::Triangulation { .. })));
        assert!(triangulate(&[]).expect("nothing").triangles.is_empty());
    }
}

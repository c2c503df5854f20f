//! Clearance: the mesh keeps farther from walls than discs must, as far as passages leave room.
//!
//! A body is wider than the disc that walls hold, so routes along walls at that disc's radius lead shoulders and arms
//! through them. A mesh grown by more would close narrow doors. Instead each vertex on a border moves away from its
//! walls, by the miter of both border edges; the triangles stay as they are. Where a triangle would lose more than
//! [`LEAST_SHARE`] leaves of its height, or turn over, or where a border would leave the mesh, the corners move by half, and
//! by half again. So wide ground gets
//! the whole clearance, and in a narrow passage the borders come together about its middle, and leave it open.
//!
//! World, metres; vertices stay on the grid.

use glam::DVec2;

use crate::route::mesh::box_tree::BoxTree;
use crate::route::mesh::route_mesh::{RouteMesh, side};
use crate::route::mesh::triangulation::NONE;
use crate::route::polygons::grid::{LINES_PER_M, metres, rounded};

/// Share of a triangle's height that clearance leaves: a quarter of a narrow passage stays free.
const LEAST_SHARE: f64 = 0.25;
/// Number of times that a vertex moves by half as much; after these it stays.
const HALVINGS_MAX: u8 = 6;
/// Shares along a moved border at which it must lie on the mesh.
const BORDER_SHARES: [f64; 3] = [0.0, 0.5, 1.0];
/// Greatest length of a miter over the clearance: borders meet at less than 60° only in corners without a route.
const MITER_MAX: f64 = 2.0;

impl RouteMesh {
    /// The mesh with its borders moved away from the walls, by a clearance where there is room.
    #[must_use]
    pub fn with_clearance(self, clearance_m: f64) -> Self {
        let push_m: Vec<DVec2> =
            (0..self.vertices_m.len() as u32).map(|vertex| clearance_m * self.miter(vertex)).collect();
        let moved_m = |vertex: usize, halvings: u8| {
            if halvings > HALVINGS_MAX {
                return self.vertices_m[vertex];
            }
            let push_m = push_m[vertex] / f64::from(1_u16 << halvings);
            metres(rounded((self.vertices_m[vertex] + push_m) * LINES_PER_M))
        };
        let mut halvings = vec![0_u8; push_m.len()];
        let mut to_m: Vec<DVec2> = (0..push_m.len()).map(|vertex| moved_m(vertex, 0)).collect();
        let mut has_changed = vec![true; push_m.len()];
        // Each round halves at least one move, and each move is halved a few times.
        loop {
            let is_new = |corners: &[u32; 3]| corners.iter().any(|&corner| has_changed[corner as usize]);
            let triangles = (0..self.triangles.len()).filter(|&triangle| is_new(&self.triangles[triangle]));
            let mut tight: Vec<u32> = triangles.flat_map(|triangle| self.tight_corners(triangle, &to_m)).collect();
            tight.retain(|&vertex| halvings[vertex as usize] <= HALVINGS_MAX);
            tight.sort_unstable();
            tight.dedup();
            if tight.is_empty() {
                break;
            }
            has_changed.fill(false);
            for vertex in tight.into_iter().map(|vertex| vertex as usize) {
                halvings[vertex] += 1;
                to_m[vertex] = moved_m(vertex, halvings[vertex]);
                has_changed[vertex] = true;
            }
        }
        self.with_vertices(to_m)
    }

    fn with_vertices(mut self, vertices_m: Vec<DVec2>) -> Self {
        self.vertices_m = vertices_m;
        self.boxes = BoxTree::new((0..self.triangles.len() as u32).map(|triangle| self.corners_m(triangle)));
        self.is_corner = (0..self.vertices_m.len() as u32).map(|vertex| self.turns_at(vertex)).collect();
        self
    }

    /// The corners of a triangle that move too far: all where it is tight, those of a border that leaves the mesh.
    fn tight_corners(&self, triangle: usize, to_m: &[DVec2]) -> Vec<u32> {
        let corners = self.triangles[triangle];
        if is_tight(corners.map(|at| [self.vertices_m[at as usize], to_m[at as usize]])) {
            return corners.to_vec();
        }
        let leaves = |edge: &usize| {
            let ends = [corners[*edge], corners[(edge + 1) % 3]];
            let [from_m, end_m] = ends.map(|end| to_m[end as usize]);
            let has_moved = ends.iter().any(|&end| self.vertices_m[end as usize] != to_m[end as usize]);
            let is_off = |share: &f64| self.triangle_at(from_m.lerp(end_m, *share)).is_none();
            has_moved && self.neighbours[triangle][*edge] == NONE && BORDER_SHARES.iter().any(is_off)
        };
        (0..3).filter(leaves).flat_map(|edge| [corners[edge], corners[(edge + 1) % 3]]).collect()
    }

    /// The vertices before and after a vertex on its border, which has free space on its left; none off borders.
    fn border_ends(&self, vertex: u32) -> Option<[u32; 2]> {
        let fan = self.fan(vertex);
        let (first, last) = (*fan.first()?, *fan.last()?);
        let [at_first, at_last] = [first, last].map(|triangle| self.corner_of(triangle, vertex));
        let is_border = self.neighbours[first as usize][at_first] == NONE;
        is_border.then(|| {
            [self.triangles[last as usize][(at_last + 2) % 3], self.triangles[first as usize][(at_first + 1) % 3]]
        })
    }

    /// The vector by which a vertex moves for its border edges to move by one.
    fn miter(&self, vertex: u32) -> DVec2 {
        let Some(ends) = self.border_ends(vertex) else { return DVec2::ZERO };
        let at_m = self.vertices_m[vertex as usize];
        let [before_m, after_m] = ends.map(|end| self.vertices_m[end as usize]);
        let [a, b] = [at_m - before_m, after_m - at_m].map(|along_m| along_m.perp().normalize_or_zero());
        ((a + b) / (1.0 + a.dot(b)).max(1e-6)).clamp_length_max(MITER_MAX)
    }

    /// Whether routes turn at a vertex: free space takes more than a half-turn around it.
    fn turns_at(&self, vertex: u32) -> bool {
        let Some(ends) = self.border_ends(vertex) else { return false };
        let [before_m, after_m] = ends.map(|end| self.vertices_m[end as usize]);
        side(self.vertices_m[vertex as usize], after_m, before_m) < 0.0
    }
}

/// Whether a triangle turns over or loses too much of a height, given each corner before and after it moves.
fn is_tight(corners_m: [[DVec2; 2]; 3]) -> bool {
    let [before_m, after_m] = [0, 1].map(|time| corners_m.map(|corner_m| corner_m[time]));
    if before_m == after_m {
        return false;
    }
    let [area_before_m2, area_after_m2] = [before_m, after_m].map(|[a, b, c]| side(a, b, c));
    let is_low = |edge: usize| {
        let [before_m, after_m] = [before_m, after_m].map(|at_m| at_m[edge].distance(at_m[(edge + 1) % 3]));
        area_after_m2 * before_m < LEAST_SHARE * area_before_m2 * after_m
    };
    area_after_m2 <= 0.0 || (0..3).any(is_low)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::route::mesh::Ground;

    const CLEARANCE_M: f64 = 0.1;

    /// A wall from x = 0 to 0.2 with a door about y = 0, and its mesh at 0.2 m, before and with clearance.
    fn door(width_m: f32) -> [RouteMesh; 2] {
        let post = |low: f32, high: f32| [[0.0, low], [0.2, low], [0.2, high], [0.0, high]].map(Vec2::from).to_vec();
        let obstacles_m = [post(-5.0, -0.5 * width_m), post(0.5 * width_m, 5.0)];
        let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
        let mesh = RouteMesh::new(&ground, 0.2).expect("small numbers");
        [mesh.clone(), mesh.with_clearance(CLEARANCE_M)]
    }

    fn holds(mesh: &RouteMesh, x: f64, y: f64) -> bool {
        mesh.triangle_at(DVec2::new(x, y)).is_some()
    }

    #[test]
    fn wide_ground_gets_the_whole_clearance() {
        let [_, mesh] = door(2.0);
        assert!(holds(&mesh, 0.51, 3.0) && !holds(&mesh, 0.49, 3.0));
        assert!(holds(&mesh, 0.1, 0.69) && !holds(&mesh, 0.1, 0.71));
    }

    #[test]
    fn narrow_doors_stay_open_about_their_middle() {
        for width_m in [0.43, 0.45, 0.5, 0.6, 0.7] {
            let [before, mesh] = door(width_m);
            assert_eq!(mesh.part_count(), 1, "{width_m}");
            assert!(holds(&mesh, 0.1, 0.0), "{width_m}");
            let beside_m = f64::from(0.5 * width_m) - 0.205;
            assert!(holds(&before, 0.1, beside_m) && !holds(&mesh, 0.1, beside_m), "{width_m}");
        }
    }

    #[test]
    fn triangles_keep_their_direction_and_routes_their_corners() {
        let [before, mesh] = door(0.5);
        assert!((0..mesh.triangle_count() as u32).all(|triangle| {
            let [a, b, c] = mesh.corners_m(triangle);
            side(a, b, c) > 0.0
        }));
        let corners = |mesh: &RouteMesh| mesh.is_corner.iter().filter(|is_corner| **is_corner).count();
        assert!(corners(&mesh) > 0 && corners(&before) > 0);
    }
}

//! Positions on the mesh: the triangle at a point, the nearest point of the mesh, and what lies between two points.
//!
//! World, metres.

use glam::DVec2;

use crate::route::mesh::gates::LEVEL_M;
use crate::route::mesh::route_mesh::RouteMesh;
use crate::route::mesh::triangulation::NONE;

/// Twice the area by which a point may lie outside an edge and still count as inside, m²: f64 rounding at 16 km.
const OUTSIDE_M2: f64 = 1e-9;
/// Greatest number of triangles that a remembered position walks over before it is searched anew.
const STEPS_MAX: usize = 16;

/// A position on the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeshPoint {
    /// A triangle that holds the position.
    pub(crate) triangle: u32,
    /// The position, m.
    pub(crate) point_m: DVec2,
}

impl RouteMesh {
    /// The triangle that holds a point; none off the mesh.
    pub(crate) fn triangle_at(&self, point_m: DVec2) -> Option<u32> {
        let outside_m2 = |triangle| if self.holds(triangle, point_m) { 0.0 } else { f64::INFINITY };
        // Only boxes that hold the point are searched.
        self.boxes.nearest(point_m, f64::MIN_POSITIVE, outside_m2).map(|(triangle, _)| triangle)
    }

    /// Walks from a triangle towards a point: the triangle that holds it, or the last one before a border.
    pub(crate) fn walk(&self, triangle: u32, point_m: DVec2) -> Result<u32, u32> {
        let mut triangle = triangle;
        for _ in 0..STEPS_MAX {
            let corners_m = self.corners_m(triangle);
            let areas_m2 = [0, 1, 2].map(|edge| {
                let from_m = corners_m[edge];
                (corners_m[(edge + 1) % 3] - from_m).perp_dot(point_m - from_m)
            });
            let edge = usize::from(areas_m2[1] < areas_m2[0]);
            let edge = if areas_m2[2] < areas_m2[edge] { 2 } else { edge };
            if areas_m2[edge] >= -OUTSIDE_M2 {
                return Ok(triangle);
            }
            let beyond = self.neighbours[triangle as usize][edge];
            if beyond == NONE {
                break;
            }
            triangle = beyond;
        }
        Err(triangle)
    }

    /// The point of the mesh that is nearest to a point, the point itself if it lies on the mesh. Counts one part of the
    /// mesh, or all; none where there are no triangles. A triangle of that part which is near makes the search quick.
    pub(crate) fn nearest(&self, point_m: DVec2, part: Option<u32>, near: Option<u32>) -> Option<MeshPoint> {
        let squared_in_m2 = |triangle: u32| self.nearest_in(triangle, point_m).distance_squared(point_m);
        let squared_m2 = |triangle: u32| {
            let counts = part.is_none_or(|part| self.parts[triangle as usize] == part);
            if counts { squared_in_m2(triangle) } else { f64::INFINITY }
        };
        let within_m2 = near.map_or(f64::INFINITY, squared_in_m2);
        let nearer = self.boxes.nearest(point_m, within_m2, squared_m2).map(|(triangle, _)| triangle);
        let triangle = nearer.or(near)?;
        Some(MeshPoint { triangle, point_m: self.nearest_in(triangle, point_m) })
    }

    /// Whether the straight line between two points stays on the mesh and leads against no one-way zone, given the
    /// triangle that holds the first.
    pub(crate) fn is_straight_free(&self, from: MeshPoint, to_m: DVec2) -> bool {
        let (mut triangle, mut entry) = (from.triangle, None);
        let gates = self.gates.as_deref();
        for _ in 0..self.triangles.len() {
            if let Some((gates, zone)) = gates.and_then(|gates| Some((gates, gates.zone(triangle)?)))
                && gates.ahead_m(zone, from.point_m, to_m) < -LEVEL_M
            {
                return false;
            }
            if self.holds(triangle, to_m) {
                return true;
            }
            let corners_m = self.corners_m(triangle);
            let left = corners_m.map(|corner_m| (to_m - from.point_m).perp_dot(corner_m - from.point_m));
            let leaves = |&edge: &usize| {
                let (from_m, next) = (corners_m[edge], (edge + 1) % 3);
                let beyond = (corners_m[next] - from_m).perp_dot(to_m - from_m) < 0.0;
                beyond && left[edge] <= OUTSIDE_M2 && left[next] >= -OUTSIDE_M2 && Some(edge) != entry
            };
            let Some(edge) = (0..3).find(leaves) else { return false };
            let beyond = self.neighbours[triangle as usize][edge];
            if beyond != NONE {
                entry = Some(self.edge_to(beyond, triangle));
                triangle = beyond;
            } else if let Some([beyond, edge]) = gates.and_then(|gates| gates.beyond(triangle, edge)) {
                (triangle, entry) = (beyond, Some(edge as usize));
            } else {
                return false;
            }
        }
        false
    }

    fn holds(&self, triangle: u32, point_m: DVec2) -> bool {
        let [a_m, b_m, c_m] = self.corners_m(triangle);
        let is_inside = |from_m: DVec2, to_m: DVec2| (to_m - from_m).perp_dot(point_m - from_m) >= -OUTSIDE_M2;
        is_inside(a_m, b_m) && is_inside(b_m, c_m) && is_inside(c_m, a_m)
    }

    /// The point of a triangle that is nearest to a point.
    pub(crate) fn nearest_in(&self, triangle: u32, point_m: DVec2) -> DVec2 {
        if self.holds(triangle, point_m) {
            return point_m;
        }
        let corners_m = self.corners_m(triangle);
        let nearest_m = |edge: usize| nearest_on_edge(point_m, corners_m[edge], corners_m[(edge + 1) % 3]);
        let nearer = |a: DVec2, b: DVec2| if b.distance_squared(point_m) < a.distance_squared(point_m) { b } else { a };
        nearer(nearer(nearest_m(0), nearest_m(1)), nearest_m(2))
    }
}

/// The point of an edge that is nearest to a point.
pub(crate) fn nearest_on_edge(point_m: DVec2, from_m: DVec2, to_m: DVec2) -> DVec2 {
    let along_m = to_m - from_m;
    let share = (point_m - from_m).dot(along_m) / along_m.length_squared().max(f64::MIN_POSITIVE);
    from_m + share.clamp(0.0, 1.0) * along_m
}

//! Shortest routes by brute force: every pair of corners that see each other, and Dijkstra's search.
//!
//! A straight line is free if every point of it lies in free space or on its border. It is cut at every corner and edge
//! that it touches, and the middle of each piece is tested. Sides are exact.

use glam::{DVec2, Vec2};

use crate::route::mesh::RouteMesh;
use crate::route::mesh::gates::LEVEL_M;
use crate::route::mesh::route_mesh::side;
use crate::world::one_way::OneWayZone;

/// The corners of free space.
pub(super) struct VisibilityGraph<'a> {
    edges_m: Vec<[DVec2; 2]>,
    mesh: &'a RouteMesh,
    /// One-way zones: a straight line through one leads not against its heading.
    pub(super) zones: &'a [OneWayZone],
}

impl<'a> VisibilityGraph<'a> {
    pub(super) fn new(contours_m: &[Vec<DVec2>], mesh: &'a RouteMesh) -> Self {
        let edges = |contour_m: &Vec<DVec2>| -> Vec<[DVec2; 2]> {
            contour_m.iter().zip(contour_m.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]).collect()
        };
        Self { edges_m: contours_m.iter().flat_map(edges).collect(), mesh, zones: &[] }
    }

    /// Length of the shortest route, m.
    pub(super) fn length_m(&self, from_m: Vec2, to_m: Vec2) -> Option<f32> {
        let corners = (0..self.mesh.vertex_count()).filter(|&vertex| self.mesh.is_corner[vertex]);
        let mut points_m: Vec<DVec2> = corners.map(|vertex| self.mesh.vertices_m[vertex]).collect();
        points_m.extend([DVec2::from(to_m), DVec2::from(from_m)]);
        let goal = points_m.len() - 2;
        let mut lengths_m = vec![f64::INFINITY; points_m.len()];
        let mut open = vec![true; points_m.len()];
        lengths_m[goal + 1] = 0.0;
        loop {
            let nearest =
                (0..points_m.len()).filter(|&at| open[at]).min_by(|&a, &b| lengths_m[a].total_cmp(&lengths_m[b]))?;
            if lengths_m[nearest] == f64::INFINITY {
                return None;
            }
            if nearest == goal {
                return Some(lengths_m[goal] as f32);
            }
            open[nearest] = false;
            for other in (0..points_m.len()).filter(|&other| open[other]) {
                let length_m = lengths_m[nearest] + points_m[nearest].distance(points_m[other]);
                if length_m < lengths_m[other]
                    && self.sees(points_m[nearest], points_m[other])
                    && self.leads(points_m[nearest], points_m[other])
                {
                    lengths_m[other] = length_m;
                }
            }
        }
    }

    /// Whether a straight line leads through no zone against its heading. Its piece within a zone is what the four sides
    /// leave of it.
    fn leads(&self, from_m: DVec2, to_m: DVec2) -> bool {
        let along_m = to_m - from_m;
        self.zones.iter().all(|zone| {
            let corners_m = zone.corners_m.map(DVec2::from);
            let (mut first, mut last) = (0.0_f64, 1.0_f64);
            for corner in 0..4 {
                let inward = (corners_m[(corner + 1) % 4] - corners_m[corner]).perp().normalize();
                let (offset_m, change_m) = (inward.dot(from_m - corners_m[corner]), inward.dot(along_m));
                let share = -offset_m / change_m;
                match change_m {
                    0.0 if offset_m <= 0.0 => return true,
                    0.0 => {}
                    change_m if change_m > 0.0 => first = first.max(share),
                    _ => last = last.min(share),
                }
            }
            (last - first) * along_m.length() < LEVEL_M || along_m.dot(zone.heading.into()) > -LEVEL_M
        })
    }

    fn sees(&self, from_m: DVec2, to_m: DVec2) -> bool {
        let along_m = to_m - from_m;
        let share_of = |point_m: DVec2| (point_m - from_m).dot(along_m) / along_m.length_squared();
        let mut shares = vec![0.0, 1.0];
        for &[a_m, b_m] in &self.edges_m {
            let [of_a, of_b] = [a_m, b_m].map(|end_m| side(from_m, to_m, end_m));
            let [of_from, of_to] = [from_m, to_m].map(|end_m| side(a_m, b_m, end_m));
            if of_a * of_b < 0.0 && of_from * of_to < 0.0 {
                return false;
            }
            for (end_m, of_end) in [(a_m, of_a), (b_m, of_b)] {
                if of_end == 0.0 {
                    shares.push(share_of(end_m));
                }
            }
        }
        shares.retain(|share| (0.0..=1.0).contains(share));
        shares.sort_by(f64::total_cmp);
        shares
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > 1e-12)
            .all(|pair| self.is_free(from_m + 0.5 * (pair[0] + pair[1]) * along_m))
    }

    /// Whether a point lies in free space or on its border, within rounding.
    fn is_free(&self, point_m: DVec2) -> bool {
        let near = |&[a_m, b_m]: &[DVec2; 2]| {
            let nearest_m = crate::route::mesh::locate::nearest_on_edge(point_m, a_m, b_m);
            nearest_m.distance(point_m) < 1e-9
        };
        let crosses = |&&[a_m, b_m]: &&[DVec2; 2]| {
            (a_m.y > point_m.y) != (b_m.y > point_m.y) && (side(a_m, b_m, point_m) > 0.0) == (b_m.y > a_m.y)
        };
        self.edges_m.iter().filter(crosses).count() % 2 == 1 || self.edges_m.iter().any(near)
    }
}

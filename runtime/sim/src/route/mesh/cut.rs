//! Cuts a mesh along the entries and exits of one-way zones, and finds the gates over which agents pass these cuts.
//!
//! 1. The borders of the mesh are its free space; the entries and exits slice it into pieces, on the grid.
//! 2. All pieces are triangulated together, so both sides of a cut have the same edges.
//! 3. A piece belongs to the zone that holds its largest triangle. Its triangles are not connected with those of other
//!    pieces; where agents may walk from one to the other, there is a gate.
//!
//! The sides of a zone along its heading need no cut: free space keeps its distance from them as from walls. World,
//! metres.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::string::overlay::StringOverlay;
use i_overlay::string::rule::StringRule;

use crate::route::mesh::gates::Gates;
use crate::route::mesh::route_mesh::RouteMesh;
use crate::route::mesh::triangulation::{CellSoup, NONE, triangulate_cells};
use crate::route::polygons::error::RouteError;
use crate::route::polygons::grid::{Contour, LINES_PER_M, grid_point, metres, rounded};
use crate::world::one_way::OneWayZone;

/// Cosine of the greatest angle between a gate's normal and the heading of its zone: edges of a millimetre, which the
/// grid turns, are no gates along a side.
const ACROSS_COS: f64 = 0.7;

impl RouteMesh {
    /// The mesh with one-way zones. Its ground must have the same zones, and it must have its clearance.
    ///
    /// # Errors
    /// If a coordinate is out of range.
    pub fn with_one_way(self, zones: &[OneWayZone]) -> Result<Self, RouteError> {
        if zones.is_empty() {
            return Ok(self);
        }
        let contours_m: Vec<Vec<DVec2>> = sliced(&self.borders(), zones)?
            .iter()
            .map(|contour| contour.iter().map(|corner| metres(*corner)).collect())
            .collect();
        Ok(Self::of_cells(triangulate_cells(&contours_m)?, zones))
    }

    /// The borders of the mesh on the grid, with free space on the left.
    fn borders(&self) -> Vec<Contour> {
        let mut next = vec![NONE; self.vertex_count()];
        for (corners, neighbours) in self.triangles.iter().zip(&self.neighbours) {
            for edge in (0..3).filter(|&edge| neighbours[edge] == NONE) {
                next[corners[edge] as usize] = corners[(edge + 1) % 3];
            }
        }
        let mut borders = Vec::new();
        for first in 0..next.len() {
            let (mut border, mut at) = (Contour::new(), first);
            while next[at] != NONE {
                border.push(rounded(self.vertices_m[at] * LINES_PER_M));
                at = std::mem::replace(&mut next[at], NONE) as usize;
            }
            borders.extend(Some(border).filter(|border| !border.is_empty()));
        }
        borders
    }

    fn of_cells(found: CellSoup, zones: &[OneWayZone]) -> Self {
        let zone_of = zones_of(&found, zones);
        let CellSoup { mut soup, beyond, .. } = found;
        // Cuts within a zone, or outside all zones, are none.
        for (triangle, neighbours) in soup.neighbours.iter_mut().enumerate() {
            for edge in 0..3 {
                let other = beyond[triangle][edge];
                if other != NONE && zone_of[other as usize] == zone_of[triangle] {
                    neighbours[edge] = other;
                }
            }
        }
        let (mut mesh, slots) = Self::of_sorted(soup);
        let mut moved_zones = vec![NONE; zone_of.len()];
        slots.iter().zip(&zone_of).for_each(|(&slot, &zone)| moved_zones[slot as usize] = zone);
        let headings = zones.iter().map(|zone| DVec2::from(zone.heading)).collect();
        let mut gates = Gates { headings, zones: moved_zones, cells: mesh.parts.clone(), ..Gates::default() };
        let mut adjacent = Vec::new();
        for (triangle, others) in beyond.iter().enumerate() {
            let from = slots[triangle];
            let cut = others.iter().enumerate().filter(|(_, other)| **other != NONE);
            for (edge, to) in cut.map(|(edge, &other)| (edge, slots[other as usize])) {
                if mesh.neighbours[from as usize][edge] != NONE {
                    continue;
                }
                adjacent.push([from, to].map(|triangle| gates.cells[triangle as usize]));
                if let Some(far) =
                    mesh.edge_between(to, from, edge).filter(|_| may_pass(&gates, &mesh, [from, to], edge))
                {
                    gates.onwards.push([[from, edge as u32], [to, far as u32]]);
                }
            }
        }
        mesh.take_gates(gates, &adjacent);
        mesh
    }

    /// The edge of a triangle that has the same ends as an edge of another one.
    fn edge_between(&self, triangle: u32, other: u32, edge: usize) -> Option<usize> {
        let (near_m, far_m) = (self.corners_m(other), self.corners_m(triangle));
        (0..3).find(|&far| far_m[far] == near_m[(edge + 1) % 3] && far_m[(far + 1) % 3] == near_m[edge])
    }

    fn take_gates(&mut self, mut gates: Gates, adjacent: &[[u32; 2]]) {
        gates.onwards.sort_unstable();
        gates.back = gates.onwards.iter().map(|&[from, to]| [to, from]).collect();
        gates.back.sort_unstable();
        for &[[from, edge], [to, far]] in &gates.onwards {
            let (near, beyond) = (self.triangles[from as usize], self.triangles[to as usize]);
            let (edge, far) = (edge as usize, far as usize);
            let ends = [[beyond[(far + 1) % 3], near[edge]], [beyond[far], near[(edge + 1) % 3]]];
            gates.vertices.extend(ends.into_iter().filter(|[beyond, before]| beyond != before));
            gates.cell_gates.push([from, to].map(|triangle| gates.cells[triangle as usize]));
        }
        gates.vertices.sort_unstable();
        gates.vertices.dedup();
        gates.cell_gates.sort_unstable();
        gates.cell_gates.dedup();
        let mut before: Vec<u32> = gates.vertices.iter().map(|&[_, before]| before).collect();
        before.sort_unstable();
        let is_before = |vertex: u32| before.binary_search(&vertex).is_ok();
        let mut turning = (0..self.vertex_count() as u32).filter(|&vertex| self.is_corner[vertex as usize]);
        gates.have_corners = turning.any(|vertex| gates.zone(self.fan(vertex)[0]).is_some() && !is_before(vertex));
        // A route may turn at the end of a gate, of which the corner lies on both sides.
        gates.vertices.iter().for_each(|&[_, before]| self.is_corner[before as usize] = true);
        self.join_parts(adjacent);
        self.gates = Some(Box::new(gates));
    }
}

/// The borders, sliced along the entries and exits of zones.
fn sliced(borders: &[Contour], zones: &[OneWayZone]) -> Result<Vec<Contour>, RouteError> {
    let mut overlay = StringOverlay::<i32>::new(borders.iter().map(Vec::len).sum());
    overlay.add_shape_source(borders);
    for [right_m, left_m] in zones.iter().flat_map(OneWayZone::gates_m) {
        overlay.add_string_line([grid_point(right_m)?, grid_point(left_m)?]);
    }
    let graph = overlay.build_graph_view(FillRule::NonZero);
    let shapes = graph.map(|graph| graph.extract_shapes(StringRule::Slice)).unwrap_or_default();
    Ok(shapes.into_iter().flatten().collect())
}

/// The zone of each triangle: of its cell, by the cell's largest triangle; [`NONE`] outside all zones.
fn zones_of(found: &CellSoup, zones: &[OneWayZone]) -> Vec<u32> {
    let cell_count = found.cells.iter().max().map_or(0, |&last| last as usize + 1);
    let mut largest = vec![(0.0, NONE); cell_count];
    for (corners, &cell) in found.soup.triangles.iter().zip(&found.cells) {
        let [a_m, b_m, c_m] = corners.map(|corner| found.soup.points_m[corner as usize]);
        let area_m2 = (b_m - a_m).perp_dot(c_m - a_m);
        if area_m2 > largest[cell as usize].0 {
            let middle_m = (a_m + b_m + c_m) / 3.0;
            let zone = zones.iter().position(|zone| zone.holds_exactly(middle_m));
            largest[cell as usize] = (area_m2, zone.map_or(NONE, |zone| zone as u32));
        }
    }
    found.cells.iter().map(|&cell| largest[cell as usize].1).collect()
}

/// Whether agents may pass from a triangle to the one beyond an edge.
fn may_pass(gates: &Gates, mesh: &RouteMesh, [from, to]: [u32; 2], edge: usize) -> bool {
    let corners_m = mesh.corners_m(from);
    let outward = -(corners_m[(edge + 1) % 3] - corners_m[edge]).perp().normalize_or_zero();
    let mut zones = [from, to].into_iter().filter_map(|triangle| gates.zone(triangle));
    zones.all(|zone| gates.headings[zone as usize].dot(outward) >= ACROSS_COS)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::route::polygons::ground::{Ground, WalkablePolygon};

    fn rectangle(low: [f32; 2], high: [f32; 2]) -> Vec<Vec2> {
        [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec()
    }

    /// A room of 20 × 4 m with one-way zones that lead to the right.
    fn room(zones_m: &[[[f32; 2]; 2]], clearance_m: f64) -> RouteMesh {
        let zones: Vec<OneWayZone> = zones_m
            .iter()
            .map(|&[low, high]| OneWayZone::new(&rectangle(low, high), 0.0).expect("a rectangle"))
            .collect();
        let room = WalkablePolygon { outline_m: rectangle([0.0, 0.0], [20.0, 4.0]), holes_m: Vec::new() };
        let ground = Ground { walkable_m: &[room], one_way: &zones, ..Ground::default() };
        let mesh = RouteMesh::new(&ground, 0.2).expect("small numbers").with_clearance(clearance_m);
        mesh.with_one_way(&zones).expect("small numbers")
    }

    fn cell(mesh: &RouteMesh, at_m: [f64; 2]) -> u32 {
        let triangle = mesh.triangle_at(DVec2::from(at_m)).expect("on the mesh");
        mesh.gates.as_ref().expect("a zone").cells[triangle as usize]
    }

    #[test]
    fn a_zone_across_a_corridor_leads_one_way() {
        for clearance_m in [0.0, 0.15] {
            let mesh = room(&[[[8.0, 0.0], [12.0, 4.0]]], clearance_m);
            let gates = mesh.gates.as_ref().expect("a zone");
            let [before, within, beyond] = [2.0, 10.0, 18.0].map(|x| cell(&mesh, [x, 2.0]));
            assert!(gates.leads(before, within) && gates.leads(within, beyond) && gates.leads(before, beyond));
            assert!(!gates.leads(beyond, within) && !gates.leads(within, before));
            assert_eq!((mesh.part_count(), gates.cell_gates.len()), (1, 2));
        }
    }

    #[test]
    fn the_sides_of_a_zone_on_open_ground_are_closed() {
        let mesh = room(&[[[8.0, 1.0], [12.0, 3.0]]], 0.0);
        let gates = mesh.gates.as_ref().expect("a zone");
        assert!(gates.leads(cell(&mesh, [2.0, 2.0]), cell(&mesh, [18.0, 2.0])));
        assert_eq!(cell(&mesh, [2.0, 2.0]), cell(&mesh, [10.0, 0.5]));
        assert!(mesh.triangle_at(DVec2::new(10.0, 1.1)).is_none());
    }

    #[test]
    fn zones_one_behind_the_other_lead_on() {
        let mesh = room(&[[[4.0, 0.0], [8.0, 4.0]], [[8.0, 0.0], [12.0, 4.0]]], 0.15);
        let gates = mesh.gates.as_ref().expect("zones");
        assert_eq!(gates.cell_gates.len(), 3);
        assert!(gates.leads(cell(&mesh, [5.0, 2.0]), cell(&mesh, [18.0, 2.0])));
        assert!(!gates.leads(cell(&mesh, [11.0, 2.0]), cell(&mesh, [5.0, 2.0])));
    }
}

//! The mesh of free space: triangles in compact arrays.
//!
//! Each vertex has exactly one fan of triangles around it. Where free space touches itself in a point, the point becomes
//! several vertices: no route leads through it. Triangles are sorted along a Morton curve. World, metres; every vertex
//! of a scene's mesh lies on the grid, so signs of areas are exact.

use glam::{DVec2, Vec2};
use robust::{Coord, orient2d};

use crate::maths::morton::morton_code;
use crate::route::mesh::box_tree::BoxTree;
use crate::route::mesh::gates::Gates;
use crate::route::mesh::triangulation::{NONE, TriangleSoup, triangulate};
use crate::route::polygons::error::RouteError;
use crate::route::polygons::free_space::FreeSpace;
use crate::route::polygons::grid::LINES_PER_M;
use crate::route::polygons::ground::Ground;

/// The triangles of free space.
#[derive(Clone, Debug, Default)]
pub struct RouteMesh {
    /// Position of each vertex, m.
    pub(crate) vertices_m: Vec<DVec2>,
    /// Vertices of each triangle, counter-clockwise.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangle beyond each edge; edge k runs from vertex k to the next one. [`NONE`] at a border.
    pub(crate) neighbours: Vec<[u32; 3]>,
    /// Index of the part of each triangle; no route leads from part to part.
    pub(crate) parts: Vec<u32>,
    part_count: u32,
    /// The part with the most triangles.
    largest_part: u32,
    /// Index of each vertex's first entry in `fans`, and the number of entries.
    fan_starts: Vec<u32>,
    /// Triangles around each vertex, counter-clockwise from border to border.
    fans: Vec<u32>,
    /// Whether free space takes more than a half-turn around the vertex: routes turn there.
    pub(crate) is_corner: Vec<bool>,
    pub(crate) boxes: BoxTree,
    /// The gates of one-way zones; none without such zones.
    pub(crate) gates: Option<Box<Gates>>,
}

impl RouteMesh {
    /// The mesh of the ground on which an agent's centre keeps a distance from all walls.
    ///
    /// # Errors
    /// If a coordinate or the distance is out of range.
    pub fn new(ground: &Ground, wall_radius_m: f32) -> Result<Self, RouteError> {
        Self::of(&FreeSpace::new(ground, wall_radius_m)?)
    }

    /// The mesh of free space.
    ///
    /// # Errors
    /// If the contours cross.
    pub fn of(space: &FreeSpace) -> Result<Self, RouteError> {
        Ok(Self::of_triangles(triangulate(&space.contours_m())?))
    }

    /// The mesh of triangles.
    pub(crate) fn of_triangles(soup: TriangleSoup) -> Self {
        Self::of_sorted(soup).0
    }

    /// The mesh of triangles, and the index in it of each of them.
    pub(crate) fn of_sorted(soup: TriangleSoup) -> (Self, Vec<u32>) {
        let (soup, slots) = sorted(soup);
        let mut mesh = Self { neighbours: soup.neighbours, triangles: soup.triangles, ..Self::default() };
        mesh.boxes = BoxTree::new(mesh.triangles.iter().map(|corners| corners.map(|at| soup.points_m[at as usize])));
        mesh.make_fans(&soup.points_m);
        mesh.number_parts();
        (mesh, slots)
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices_m.len()
    }

    /// Number of parts: no route leads from one to another.
    pub fn part_count(&self) -> u32 {
        self.part_count
    }

    /// The part of a triangle, or its cell where one-way zones divide parts: routes from all its triangles lead to the same
    /// places, save for those within zones.
    pub(crate) fn cell(&self, triangle: u32) -> u32 {
        self.gates.as_ref().map_or(&self.parts, |gates| &gates.cells)[triangle as usize]
    }

    /// Whether triangles lie in one part, and gates of one-way zones lead from one to the other.
    pub(crate) fn leads(&self, from: u32, to: u32) -> bool {
        let is_one_part = self.parts[from as usize] == self.parts[to as usize];
        is_one_part && self.gates.as_ref().is_none_or(|gates| gates.leads(self.cell(from), self.cell(to)))
    }

    /// Whether a position lies on the mesh, in its part with the most triangles.
    pub fn largest_part_holds(&self, position_m: Vec2) -> bool {
        let part = self.triangle_at(DVec2::from(position_m)).map(|triangle| self.parts[triangle as usize]);
        part.is_some_and(|part| part == self.largest_part)
    }

    /// Ends of every edge, m, and whether it is a border of free space; inner edges are here once.
    pub fn edges_m(&self) -> impl Iterator<Item = ([Vec2; 2], bool)> + '_ {
        (0..self.triangles.len()).flat_map(move |triangle| {
            let corners_m = self.corners_m(triangle as u32).map(DVec2::as_vec2);
            (0..3).filter_map(move |edge| {
                let beyond = self.neighbours[triangle][edge];
                let is_first = beyond == NONE || triangle < beyond as usize;
                is_first.then_some(([corners_m[edge], corners_m[(edge + 1) % 3]], beyond == NONE))
            })
        })
    }

    /// Size in memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.vertices_m[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.neighbours[..])
            + size_of_val(&self.parts[..])
            + size_of_val(&self.fan_starts[..])
            + size_of_val(&self.fans[..])
            + size_of_val(&self.is_corner[..])
            + self.boxes.bytes()
            + self.gates.as_ref().map_or(0, |gates| gates.bytes())
    }

    /// Positions of a triangle's corners, m.
    pub(crate) fn corners_m(&self, triangle: u32) -> [DVec2; 3] {
        self.triangles[triangle as usize].map(|vertex| self.vertices_m[vertex as usize])
    }

    /// The triangles around a vertex, counter-clockwise from border to border.
    pub(crate) fn fan(&self, vertex: u32) -> &[u32] {
        &self.fans[self.fan_starts[vertex as usize] as usize..self.fan_starts[vertex as usize + 1] as usize]
    }

    /// The corner, 0 to 2, at which a triangle has a vertex.
    pub(crate) fn corner_of(&self, triangle: u32, vertex: u32) -> usize {
        let [first, second, _] = self.triangles[triangle as usize];
        if vertex == first { 0 } else { 1 + usize::from(vertex != second) }
    }

    /// The edge, 0 to 2, of a triangle beyond which another one lies.
    pub(crate) fn edge_to(&self, triangle: u32, neighbour: u32) -> usize {
        let [first, second, _] = self.neighbours[triangle as usize];
        if neighbour == first { 0 } else { 1 + usize::from(neighbour != second) }
    }

    /// Makes a vertex of each fan of triangles, and renames the triangles' corners.
    fn make_fans(&mut self, points_m: &[DVec2]) {
        let points = std::mem::replace(&mut self.triangles, vec![[NONE; 3]; self.neighbours.len()]);
        self.fan_starts.push(0);
        for first in 0..points.len() {
            for corner in 0..3 {
                if self.triangles[first][corner] == NONE {
                    self.make_fan(&points, points_m, first, corner);
                }
            }
        }
    }

    fn make_fan(&mut self, points: &[[u32; 3]], points_m: &[DVec2], triangle: usize, corner: usize) {
        let (point, vertex) = (points[triangle][corner], self.vertices_m.len() as u32);
        let corner_in = |triangle: usize| points[triangle].iter().position(|&at| at == point).unwrap_or_default();
        let (mut first, mut at) = (triangle, corner);
        // Clockwise, to the border.
        loop {
            let next = self.neighbours[first][at];
            if next == NONE || next as usize == triangle {
                break;
            }
            (first, at) = (next as usize, corner_in(next as usize));
        }
        let mut last = first;
        loop {
            at = corner_in(last);
            self.triangles[last][at] = vertex;
            self.fans.push(last as u32);
            let next = self.neighbours[last][(at + 2) % 3];
            if next == NONE || next as usize == first {
                break;
            }
            last = next as usize;
        }
        let (at_m, ends) =
            (points_m[point as usize], [points[first][(corner_in(first) + 1) % 3], points[last][(at + 2) % 3]]);
        let [right_m, left_m] = ends.map(|end| points_m[end as usize]);
        self.vertices_m.push(at_m);
        self.fan_starts.push(self.fans.len() as u32);
        self.is_corner.push(side(at_m, right_m, left_m) < 0.0);
    }

    fn number_parts(&mut self) {
        self.parts = vec![NONE; self.triangles.len()];
        let mut open = Vec::new();
        for first in 0..self.triangles.len() as u32 {
            if self.parts[first as usize] != NONE {
                continue;
            }
            open.push(first);
            while let Some(triangle) = open.pop() {
                if triangle != NONE && self.parts[triangle as usize] == NONE {
                    self.parts[triangle as usize] = self.part_count;
                    open.extend(self.neighbours[triangle as usize]);
                }
            }
            self.part_count += 1;
        }
        self.find_largest_part();
    }

    /// Makes one part of parts that one-way zones separate, given pairs of them.
    pub(crate) fn join_parts(&mut self, pairs: &[[u32; 2]]) {
        let mut joined: Vec<u32> = (0..self.part_count).collect();
        let first = |joined: &[u32], mut part: u32| {
            while joined[part as usize] != part {
                part = joined[part as usize];
            }
            part
        };
        for pair in pairs {
            let [a, b] = pair.map(|part| first(&joined, part));
            joined[a.max(b) as usize] = a.min(b);
        }
        let mut names = vec![NONE; joined.len()];
        self.part_count = 0;
        for part in &mut self.parts {
            let name = &mut names[first(&joined, *part) as usize];
            if *name == NONE {
                *name = self.part_count;
                self.part_count += 1;
            }
            *part = *name;
        }
        self.find_largest_part();
    }

    fn find_largest_part(&mut self) {
        let mut sizes = vec![0_u32; self.part_count as usize];
        self.parts.iter().for_each(|&part| sizes[part as usize] += 1);
        self.largest_part = (0..self.part_count).rev().max_by_key(|&part| sizes[part as usize]).unwrap_or_default();
    }
}

/// Positive where c lies left of the line from a to b, negative where it lies right; the sign is exact.
pub(crate) fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|point| Coord { x: point.x, y: point.y });
    orient2d(a, b, c)
}

/// The triangles in the order of their centres along a Morton curve, and the new index of each.
fn sorted(soup: TriangleSoup) -> (TriangleSoup, Vec<u32>) {
    let low_m = soup.points_m.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let code = |triangle: usize| {
        let sum_m = soup.triangles[triangle].iter().map(|at| soup.points_m[*at as usize] - low_m).sum::<DVec2>();
        let lines = sum_m * (LINES_PER_M / 3.0);
        morton_code(lines.x as u32, lines.y as u32)
    };
    let mut order: Vec<(u64, u32)> = (0..soup.triangles.len()).map(|at| (code(at), at as u32)).collect();
    order.sort_unstable();
    let mut slots = vec![NONE; order.len()];
    for (slot, &(_, triangle)) in order.iter().enumerate() {
        slots[triangle as usize] = slot as u32;
    }
    let slot = |triangle: u32| if triangle == NONE { NONE } else { slots[triangle as usize] };
    let triangles = order.iter().map(|&(_, triangle)| soup.triangles[triangle as usize]).collect();
    let neighbours = order.iter().map(|&(_, triangle)| soup.neighbours[triangle as usize].map(slot)).collect();
    (TriangleSoup { points_m: soup.points_m, triangles, neighbours }, slots)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    fn polygon(corners_m: &[[f32; 2]]) -> Vec<Vec2> {
        corners_m.iter().copied().map(Vec2::from).collect()
    }

    fn check_arrays(mesh: &RouteMesh) {
        for triangle in 0..mesh.triangle_count() as u32 {
            let [a_m, b_m, c_m] = mesh.corners_m(triangle);
            assert!(side(a_m, b_m, c_m) > 0.0);
            for (corner, vertex) in mesh.triangles[triangle as usize].into_iter().enumerate() {
                assert!(mesh.fan(vertex).contains(&triangle) && mesh.corner_of(triangle, vertex) == corner);
                let neighbour = mesh.neighbours[triangle as usize][corner];
                if neighbour != NONE {
                    assert_eq!(mesh.parts[neighbour as usize], mesh.parts[triangle as usize]);
                    let back = mesh.edge_to(neighbour, triangle);
                    assert_eq!(mesh.triangles[neighbour as usize][(back + 1) % 3], vertex);
                }
            }
        }
        let fans: usize = (0..mesh.vertex_count() as u32).map(|vertex| mesh.fan(vertex).len()).sum();
        assert_eq!(fans, 3 * mesh.triangle_count());
    }

    #[test]
    fn a_block_on_open_ground_has_eight_corners() {
        let obstacles_m = [polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])];
        let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
        let mesh = RouteMesh::new(&ground, 0.2).expect("small numbers");
        check_arrays(&mesh);
        assert_eq!((mesh.part_count(), mesh.is_corner.iter().filter(|corner| **corner).count()), (1, 8));
    }

    #[test]
    fn a_wall_across_a_room_makes_two_parts() {
        let room = crate::route::polygons::ground::WalkablePolygon {
            outline_m: polygon(&[[0.0, 0.0], [9.0, 0.0], [9.0, 5.0], [0.0, 5.0]]),
            holes_m: vec![polygon(&[[1.0, 1.0], [2.0, 1.0], [1.5, 2.0]])],
        };
        let wall_m = [polygon(&[[4.0, 0.0], [4.0, 5.0]])];
        let ground = Ground { walkable_m: std::slice::from_ref(&room), ..Ground::default() };
        let mesh = RouteMesh::new(&ground, 0.2).expect("small numbers");
        check_arrays(&mesh);
        assert_eq!(mesh.part_count(), 1);
        let mesh = RouteMesh::new(&Ground { obstacles_m: &wall_m, ..ground }, 0.2).expect("small numbers");
        check_arrays(&mesh);
        assert_eq!(mesh.part_count(), 2);
    }

    #[test]
    fn a_point_where_space_touches_itself_is_no_passage() {
        let [low, high] = [0.0, 1.0].map(|low| {
            let high = low + 1.0;
            [[low, low], [high, low], [high, high], [low, high]].map(DVec2::from).to_vec()
        });
        let mesh = RouteMesh::of_triangles(triangulate(&[low, high]).expect("they touch"));
        check_arrays(&mesh);
        assert_eq!((mesh.part_count(), mesh.vertex_count()), (2, 8));
    }

    #[test]
    fn the_same_ground_gives_the_same_mesh() {
        let obstacles_m = [
            polygon(&[[0.0, 0.0], [1.0, 0.3], [1.0, 1.0], [0.0, 1.0]]),
            polygon(&[[0.5, 0.5], [3.0, 1.0], [2.0, 2.0]]),
        ];
        let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
        let mesh = || format!("{:?}", RouteMesh::new(&ground, 0.2));
        assert_eq!(mesh(), mesh());
    }
}

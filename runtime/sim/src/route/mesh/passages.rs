//! Passages that routes cannot take: gaps between walls that an agent's distance from walls closes.
//!
//! 1. The ground between the walls, not grown, is triangulated. Where a corner is near an edge, the nearest point of the
//!    edge becomes a corner too. So the narrowest line across any gap is an edge of a triangle: the disc over that line
//!    holds no other corner, and such lines belong to every Delaunay triangulation.
//! 2. Inner edges shorter than twice the distance are *gates*. They divide the ground into regions.
//! 3. Regions that hold no part of the mesh and have one gate are niches; their gates are dropped, again and again.
//! 4. Gates join regions, the widest first. A gate that joins two sets of regions with parts of the mesh is a passage
//!    that separates. A gate within a set with parts of the mesh is a passage too, with a detour around it.
//!
//! Every gap wider than [`LEAST_M`] is found whose both sides an agent can reach. Of several gaps in a row the
//! narrowest is reported. World, metres.

use std::collections::BTreeMap;

use glam::{DVec2, Vec2};

use crate::route::mesh::locate::nearest_on_edge;
use crate::route::mesh::route_mesh::RouteMesh;
use crate::route::mesh::triangulation::{NONE, triangulate};
use crate::route::polygons::error::RouteError;
use crate::route::polygons::free_space::{FreeSpace, GRID_ALLOWANCE_M};
use crate::route::polygons::ground::Ground;
use crate::world::obstacles::edge_grid::EdgeGrid;

/// Least width of a gap that is reported, m: narrower ones are taken for walls that touch.
const LEAST_M: f64 = 5e-3;
/// Allowance for gaps that the mesh just closes, m: rounding to the grid in each round of unions. Gaps that it leaves
/// open are no gates.
const NARROW_ALLOWANCE_M: f64 = 30e-3;
/// Least distance of a new corner from others on its edge, m: two lines of the grid.
const CORNERS_APART_M: f64 = 2e-3;

/// Number of corners that are tried for lying in a disc.
const CORNERS_TRIED: usize = 16;

/// A gap between walls that is too narrow for routes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedPassage {
    /// The middle of the gap, m.
    pub at_m: Vec2,
    /// Its width, m.
    pub width_m: f32,
    /// Whether the gap closed separates parts of the mesh; otherwise a route leads around it.
    pub separates: bool,
}

/// An inner edge of the triangles that is too short for an agent.
struct Gate {
    at_m: DVec2,
    width_m: f64,
    regions: [u32; 2],
}

/// The passages of a ground that are closed in its mesh: those that separate first, the widest first.
///
/// # Errors
/// If a coordinate is out of range.
pub fn closed_passages(
    ground: &Ground,
    wall_radius_m: f32,
    mesh: &RouteMesh,
) -> Result<Vec<ClosedPassage>, RouteError> {
    let narrow_m = 2.0 * (f64::from(wall_radius_m) + GRID_ALLOWANCE_M) + NARROW_ALLOWANCE_M;
    let contours_m = FreeSpace::between_walls(ground)?.contours_m();
    // New corners lie beside their edges by rounding; without them gates are only longer.
    let soup = triangulate(&with_nearest_points(&contours_m, narrow_m)).or_else(|_| triangulate(&contours_m))?;
    let space = RouteMesh::of_triangles(soup);
    let edges: Vec<InnerEdge> = inner_edges(&space).collect();
    let (short, passable): (Vec<_>, Vec<_>) = edges.into_iter().partition(|edge| edge.is_gate(mesh, narrow_m));
    let (region_of, count) = regions(&space, &passable);
    let holds_mesh = regions_with_mesh(&space, &region_of, count, mesh);
    let mut gates = gates(&short, &region_of);
    drop_niches(&mut gates, &holds_mesh);
    gates.sort_by(|a, b| b.width_m.total_cmp(&a.width_m));
    let mut passages = joining(&gates, holds_mesh);
    passages.sort_by_key(|passage| !passage.separates);
    Ok(passages)
}

/// An edge between two triangles.
struct InnerEdge {
    triangles: [u32; 2],
    width_m: f64,
    /// Its middle, m.
    at_m: DVec2,
}

impl InnerEdge {
    /// Whether the edge is too short for an agent, and the mesh closes it.
    fn is_gate(&self, mesh: &RouteMesh, narrow_m: f64) -> bool {
        self.width_m < narrow_m && (self.width_m < LEAST_M || mesh.triangle_at(self.at_m).is_none())
    }
}

/// The contours with a new corner on each edge at its point nearest to a corner that is near.
fn with_nearest_points(contours_m: &[Vec<DVec2>], near_m: f64) -> Vec<Vec<DVec2>> {
    let edges_of = |contour_m: &Vec<DVec2>| -> Vec<[DVec2; 2]> {
        contour_m.iter().zip(contour_m.iter().cycle().skip(1)).map(|(from_m, to_m)| [*from_m, *to_m]).collect()
    };
    let edges_m: Vec<[DVec2; 2]> = contours_m.iter().flat_map(edges_of).collect();
    let grid = EdgeGrid::new(&edges_m.iter().map(|ends_m| ends_m.map(|end_m| end_m.as_vec2())).collect::<Vec<_>>());
    let mut new: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    for &[corner_m, _] in &edges_m {
        let near: Vec<u32> = grid.within((corner_m - near_m).as_vec2(), (corner_m + near_m).as_vec2()).collect();
        let others_m = nearest_corners(corner_m, near.iter().map(|&edge| edges_m[edge as usize][0]));
        for edge in near {
            let [from_m, to_m] = edges_m[edge as usize];
            let nearest_m = nearest_on_edge(corner_m, from_m, to_m);
            let inside = [from_m, to_m].iter().all(|end_m| end_m.distance(nearest_m) > CORNERS_APART_M);
            let is_empty = others_m.iter().all(|other_m| (corner_m - other_m).dot(nearest_m - other_m) >= 0.0);
            if inside && is_empty && nearest_m.distance(corner_m) < near_m {
                new.entry(edge).or_default().push(from_m.distance(nearest_m));
            }
        }
    }
    let with_new = |edge: usize| {
        let [from_m, to_m] = edges_m[edge];
        let mut along_m = new.get(&(edge as u32)).cloned().unwrap_or_default();
        along_m.sort_by(f64::total_cmp);
        along_m.dedup_by(|next_m, before_m| *next_m - *before_m < CORNERS_APART_M);
        let length_m = from_m.distance(to_m);
        std::iter::once(from_m).chain(along_m.into_iter().map(move |along_m| from_m.lerp(to_m, along_m / length_m)))
    };
    let mut first = 0;
    let split = |contour_m: &Vec<DVec2>| {
        let edges = first..first + contour_m.len();
        first = edges.end;
        edges.flat_map(with_new).collect()
    };
    contours_m.iter().map(split).collect()
}

/// The corners nearest to one, [`CORNERS_TRIED`] at most: if the disc over a line from it holds any, the line is no
/// edge of a Delaunay triangulation, nor the narrowest across a gap.
fn nearest_corners(corner_m: DVec2, others_m: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut others_m: Vec<DVec2> = others_m.filter(|other_m| *other_m != corner_m).collect();
    let by_distance = |a: &DVec2, b: &DVec2| a.distance_squared(corner_m).total_cmp(&b.distance_squared(corner_m));
    if others_m.len() > CORNERS_TRIED {
        others_m.select_nth_unstable_by(CORNERS_TRIED, by_distance);
        others_m.truncate(CORNERS_TRIED);
    }
    others_m
}

/// Every inner edge once.
fn inner_edges(space: &RouteMesh) -> impl Iterator<Item = InnerEdge> {
    let edges = (0..space.triangle_count() as u32).flat_map(|triangle| (0..3).map(move |edge| (triangle, edge)));
    edges.filter_map(|(triangle, edge)| {
        let beyond = space.neighbours[triangle as usize][edge];
        let (corners_m, next) = (space.corners_m(triangle), (edge + 1) % 3);
        let (width_m, at_m) = (corners_m[edge].distance(corners_m[next]), corners_m[edge].midpoint(corners_m[next]));
        let is_first = beyond != NONE && triangle < beyond;
        is_first.then_some(InnerEdge { triangles: [triangle, beyond], width_m, at_m })
    })
}

/// The region of each triangle, and the number of regions: triangles that passable edges join.
fn regions(space: &RouteMesh, passable: &[InnerEdge]) -> (Vec<u32>, usize) {
    let mut sets = DisjointSets::new(space.triangle_count());
    for &InnerEdge { triangles: [triangle, beyond], .. } in passable {
        sets.join(triangle, beyond);
    }
    let (mut numbers, mut count) = (vec![NONE; space.triangle_count()], 0);
    let region_of = (0..space.triangle_count() as u32).map(|triangle| {
        let number = &mut numbers[sets.of(triangle) as usize];
        if *number == NONE {
            *number = count;
            count += 1;
        }
        *number
    });
    (region_of.collect(), count as usize)
}

/// Which regions hold a part of the mesh. A part does not cross gates, so one of its triangles decides.
fn regions_with_mesh(space: &RouteMesh, region_of: &[u32], count: usize, mesh: &RouteMesh) -> Vec<bool> {
    let (mut holds_mesh, mut next_part) = (vec![false; count], 0);
    for triangle in 0..mesh.triangle_count() as u32 {
        // Parts are numbered in the order of their first triangles.
        if mesh.parts[triangle as usize] == next_part {
            next_part += 1;
            let middle_m = mesh.corners_m(triangle).iter().sum::<DVec2>() / 3.0;
            if let Some(at) = space.triangle_at(middle_m) {
                holds_mesh[region_of[at as usize] as usize] = true;
            }
        }
    }
    holds_mesh
}

fn gates(short: &[InnerEdge], region_of: &[u32]) -> Vec<Gate> {
    let gate = |&InnerEdge { triangles, width_m, at_m }: &InnerEdge| Gate {
        at_m,
        width_m,
        regions: triangles.map(|triangle| region_of[triangle as usize]),
    };
    short.iter().filter(|edge| edge.width_m >= LEAST_M).map(gate).collect()
}

/// Drops the gates of regions without mesh that have one gate only, until there are none.
fn drop_niches(gates: &mut Vec<Gate>, holds_mesh: &[bool]) {
    let mut count_of = vec![0_u32; holds_mesh.len()];
    let mut gates_of = vec![Vec::new(); holds_mesh.len()];
    for (index, gate) in gates.iter().enumerate() {
        for region in gate.regions {
            count_of[region as usize] += 1;
            gates_of[region as usize].push(index);
        }
    }
    let mut dropped = vec![false; gates.len()];
    let is_niche = |region: usize, count_of: &[u32]| !holds_mesh[region] && count_of[region] == 1;
    let mut niches: Vec<usize> = (0..holds_mesh.len()).filter(|&region| is_niche(region, &count_of)).collect();
    while let Some(niche) = niches.pop() {
        for &gate in &gates_of[niche] {
            if !std::mem::replace(&mut dropped[gate], true) {
                for region in gates[gate].regions {
                    count_of[region as usize] -= 1;
                    if is_niche(region as usize, &count_of) {
                        niches.push(region as usize);
                    }
                }
            }
        }
    }
    let mut index = 0..;
    gates.retain(|_| index.next().is_some_and(|index| !dropped[index]));
}

/// The gates, the widest first, that join regions with mesh.
fn joining(gates: &[Gate], mut holds_mesh: Vec<bool>) -> Vec<ClosedPassage> {
    let mut sets = DisjointSets::new(holds_mesh.len());
    let mut passages = Vec::new();
    for gate in gates {
        let [a, b] = gate.regions.map(|region| sets.of(region));
        let [a_holds, b_holds] = [a, b].map(|set| holds_mesh[set as usize]);
        if a_holds && b_holds {
            passages.push(ClosedPassage { at_m: gate.at_m.as_vec2(), width_m: gate.width_m as f32, separates: a != b });
        }
        let joined = sets.join(a, b);
        holds_mesh[joined as usize] = a_holds || b_holds;
    }
    passages
}

/// Sets of numbers, which can be joined.
struct DisjointSets(Vec<u32>);

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The least number of the set that holds a number.
    fn of(&mut self, number: u32) -> u32 {
        let mut at = number;
        while self.0[at as usize] != at {
            // Halves the path for the next time.
            self.0[at as usize] = self.0[self.0[at as usize] as usize];
            at = self.0[at as usize];
        }
        at
    }

    /// Joins the sets of two numbers. Returns the least number of the joined set.
    fn join(&mut self, a: u32, b: u32) -> u32 {
        let [a, b] = [self.of(a), self.of(b)];
        self.0[a.max(b) as usize] = a.min(b);
        a.min(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(x: f32, y: f32, width_m: f32, depth_m: f32) -> Vec<Vec2> {
        [[x, y], [x + width_m, y], [x + width_m, y + depth_m], [x, y + depth_m]].map(Vec2::from).to_vec()
    }

    /// A room of 10 × 10 m with walls of 0.2 m, and obstacles within.
    fn passages(obstacles_m: &[Vec<Vec2>], wall_radius_m: f32) -> Vec<ClosedPassage> {
        let walls_m = [
            block(-0.2, -0.2, 10.4, 0.2),
            block(-0.2, 10.0, 10.4, 0.2),
            block(-0.2, 0.0, 0.2, 10.0),
            block(10.0, 0.0, 0.2, 10.0),
        ];
        let obstacles_m = [&walls_m, obstacles_m].concat();
        let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
        let mesh = RouteMesh::new(&ground, wall_radius_m).expect("small numbers");
        closed_passages(&ground, wall_radius_m, &mesh).expect("small numbers")
    }

    fn check(obstacles_m: &[Vec<Vec2>], expected: &[([f32; 2], f32, bool)]) {
        let found = passages(obstacles_m, 0.2);
        let same = |passage: &ClosedPassage, &(at_m, width_m, separates): &([f32; 2], f32, bool)| {
            let near = passage.at_m.distance(Vec2::from(at_m)) < 0.3;
            near && (passage.width_m - width_m).abs() < 2e-3 && passage.separates == separates
        };
        let all =
            found.len() == expected.len() && found.iter().zip(expected).all(|(found, expected)| same(found, expected));
        assert!(all, "{found:?}");
    }

    #[test]
    fn a_narrow_door_is_found_and_a_wide_one_is_not() {
        let door = |width_m: f32| [block(4.0, 0.0, 0.2, 5.0), block(4.0, 5.0 + width_m, 0.2, 5.0 - width_m)];
        check(&door(0.3), &[([4.1, 5.15], 0.3, true)]);
        check(&door(0.39), &[([4.1, 5.195], 0.39, true)]);
        check(&door(0.6), &[]);
        // Walls that touch have no passage between them.
        check(&door(0.001), &[]);
    }

    #[test]
    fn passages_with_a_detour_do_not_separate() {
        let doors = [block(4.0, 0.0, 0.2, 3.0), block(4.0, 3.3, 0.2, 3.0), block(4.0, 7.5, 0.2, 2.5)];
        check(&doors, &[([4.1, 3.15], 0.3, false)]);
        check(&[block(3.0, 0.1, 1.0, 1.0)], &[([4.0, 0.05], 0.1, false)]);
    }

    #[test]
    fn a_wide_block_leaves_a_gap_beside_a_wall() {
        // A block across the room: 0.35 m to one wall, 0.25 m to the other.
        check(&[block(0.35, 4.0, 9.4, 1.0)], &[([0.175, 5.0], 0.35, true), ([9.875, 5.0], 0.25, false)]);
    }

    #[test]
    fn niches_and_long_narrow_corridors() {
        let niche = [block(0.0, 0.0, 3.0, 1.0), block(3.3, 0.0, 6.7, 1.0)];
        check(&niche, &[]);
        let corridor = [block(0.0, 4.0, 3.0, 2.0), block(3.3, 4.0, 6.7, 2.0)];
        check(&corridor, &[([3.15, 6.0], 0.3, true)]);
    }

    #[test]
    fn gaps_beside_an_enclosure_are_found() {
        let room = vec![block(0.0, -5.0, 10.0, 10.0)];
        let walls = [block(5.0, -4.62, 0.2, 9.62)];
        for obstacles_m in [&walls[..], &[block(5.0, -4.62, 0.2, 9.0), block(5.1, 4.0, 0.2, 2.0)]] {
            let ground = Ground { obstacles_m, enclosures_m: &room, ..Ground::default() };
            let mesh = RouteMesh::new(&ground, 0.2).expect("small numbers");
            let found = closed_passages(&ground, 0.2, &mesh).expect("small numbers");
            let [ClosedPassage { at_m, width_m, separates }] = found[..] else { panic!("{found:?}") };
            assert!(at_m.distance(Vec2::new(5.1, -4.81)) < 0.2 && separates, "{at_m}");
            assert!((width_m - 0.38).abs() < 5e-3, "{width_m}");
        }
    }
}

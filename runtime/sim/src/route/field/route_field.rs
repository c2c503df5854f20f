//! The shortest routes from everywhere to one goal: the search kept, and queries.
//!
//! Each triangle keeps the cones that reach into it, by the least length of their routes. A query takes the triangle at
//! a position and the cone with the shortest route to it. No route is stored for an agent, so an agent that is pushed
//! aside just queries again. World, metres.

use glam::{DVec2, Vec2};

use crate::route::field::flood::{Flood, FloodSource, FoundCone};
use crate::route::field::interval::{NO_RAY, OUTSIDE_M2, level_zone};
use crate::route::field::route_goal::RouteGoal;
use crate::route::mesh::RouteMesh;
use crate::route::mesh::gates::LEVEL_M;
use crate::route::mesh::locate::MeshPoint;
use crate::route::mesh::triangulation::NONE;

/// Stands for the ray on which the route came to the root, continued.
const PARENT_RAY: u32 = u32::MAX - 1;
/// Distance off the mesh that counts as on it, m: rounding of an agent that walks along a border.
const BESIDE_M: f64 = 1e-3;
/// Distance within which a corner is reached, m; the grid's resolution.
const REACHED_M: f64 = 1e-3;
/// Distance within which the nearest point of the mesh to a goal off the mesh is reached, m.
const GOAL_SIDE_REACHED_M: f64 = 0.05;

/// The shortest routes from everywhere to one goal.
#[derive(Clone, Debug)]
pub struct RouteField {
    goal: RouteGoal,
    /// Index of each triangle's first interval, and the number of intervals.
    starts: Vec<u32>,
    intervals: Vec<FieldInterval>,
    roots: Vec<FieldRoot>,
    /// Index of the first root that is a point of the goal off the mesh.
    first_off_mesh: u32,
}

/// A source of a field.
#[derive(Clone, Copy, Debug)]
struct GoalSource {
    source: FloodSource,
    /// The point of the goal, where it lies off the mesh, m.
    off_mesh_m: Option<DVec2>,
}

/// A cone that reaches into a triangle.
#[derive(Clone, Copy, Debug)]
struct FieldInterval {
    /// Index of its root.
    root: u32,
    /// Vertex on its left ray; [`PARENT_RAY`] or [`NO_RAY`].
    left: u32,
    /// The same of the right ray.
    right: u32,
    /// Lower bound of the lengths of its routes, m.
    least_m: f32,
}

/// A corner at which routes turn, or an end of all routes.
#[derive(Clone, Copy, Debug)]
struct FieldRoot {
    point_m: DVec2,
    /// Length of the route from here, m.
    distance_m: f64,
    /// Index of the next root on the route; [`NONE`] at its end.
    parent: u32,
}

/// Where an agent was on the mesh in its last query; makes the next one quick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoutePosition {
    triangle: u32,
}

impl Default for RoutePosition {
    fn default() -> Self {
        Self { triangle: NONE }
    }
}

/// The route onwards from a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteStep {
    /// Length of the route to the goal, m.
    pub distance_m: f32,
    /// The next corner of the route, or its end, m. It is in sight from the position, or from `entry_m`.
    pub next_m: Vec2,
    /// The corner after that one, or the end, m. None where `next_m` is the end.
    pub after_m: Option<Vec2>,
    /// The nearest point of the mesh, m, where the position lies off the mesh: nearer to a wall than the mesh keeps.
    pub entry_m: Option<Vec2>,
}

impl RouteField {
    /// Floods the mesh from a goal. Points of the goal off the mesh are replaced by the nearest ones of the mesh; those
    /// of an area only if all of them lie off it.
    pub fn new(mesh: &RouteMesh, goal: RouteGoal) -> Self {
        let goal_sources = sources(mesh, &goal);
        let sources: Vec<FloodSource> = goal_sources.iter().map(|source| source.source).collect();
        let mut flood = Flood::run(mesh, &sources, None);
        let mut found = std::mem::take(&mut flood.found);
        if !found.is_sorted_by(|a, b| a.least_m <= b.least_m) {
            found.sort_by(|a, b| a.least_m.total_cmp(&b.least_m));
        }
        let (roots, slots) = roots(mesh, &flood, &found, &goal_sources);
        let off_mesh = goal_sources.iter().filter(|source| source.off_mesh_m.is_some()).count();
        let (starts, intervals) = intervals(mesh, &found, &slots);
        Self { goal, starts, intervals, first_off_mesh: (roots.len() - off_mesh) as u32, roots }
    }

    /// The goal of the field.
    pub fn goal(&self) -> &RouteGoal {
        &self.goal
    }

    /// Size in memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.starts[..]) + size_of_val(&self.intervals[..]) + size_of_val(&self.roots[..])
    }

    /// The route onwards from a position. None only where the goal lies in another part of the mesh, or there is no
    /// mesh. The remembered position must be of the same mesh.
    pub fn step(&self, mesh: &RouteMesh, position_m: Vec2, remembered: &mut RoutePosition) -> Option<RouteStep> {
        let position_m = DVec2::from(position_m);
        let (at, entry_m) = remembered.find(mesh, position_m)?;
        let to_entry_m = entry_m.map_or(0.0, |entry_m| entry_m.distance(position_m));
        let step = |distance_m: f64, next_m: DVec2, after_m: Option<DVec2>| RouteStep {
            distance_m: (distance_m + to_entry_m) as f32,
            next_m: next_m.as_vec2(),
            after_m: after_m.map(DVec2::as_vec2),
            entry_m: entry_m.map(DVec2::as_vec2),
        };
        let goal_m = self.goal.nearest_m(at.point_m);
        if goal_m == Some(at.point_m) {
            return Some(step(0.0, at.point_m, None));
        }
        let (mut root, mut distance_m) = self.nearest_root(mesh, at)?;
        if let Some(goal_m) = goal_m.filter(|_| self.roots[root as usize].parent == NONE)
            && mesh.is_straight_free(at, goal_m)
        {
            return Some(step(goal_m.distance(at.point_m), goal_m, None));
        }
        let FieldRoot { mut point_m, mut parent, .. } = self.roots[root as usize];
        while parent != NONE && point_m.distance(at.point_m) < self.reached_m(parent) {
            (root, distance_m) = (parent, self.roots[parent as usize].distance_m);
            FieldRoot { point_m, parent, .. } = self.roots[root as usize];
            distance_m += point_m.distance(at.point_m);
        }
        Some(step(distance_m, point_m, (parent != NONE).then(|| self.roots[parent as usize].point_m)))
    }

    /// The corners of the route from a position to the goal, its end included, m.
    pub fn corners_m(&self, mesh: &RouteMesh, position_m: Vec2, remembered: &mut RoutePosition) -> Option<Vec<Vec2>> {
        let (at, _) = remembered.find(mesh, DVec2::from(position_m))?;
        let (first, _) = self.nearest_root(mesh, at)?;
        let parent = |&root: &u32| Some(self.roots[root as usize].parent).filter(|&parent| parent != NONE);
        Some(
            std::iter::successors(Some(first), parent)
                .map(|root| self.roots[root as usize].point_m.as_vec2())
                .collect(),
        )
    }

    /// Distance within which a root before `parent` counts as reached, m.
    fn reached_m(&self, parent: u32) -> f64 {
        if parent >= self.first_off_mesh { GOAL_SIDE_REACHED_M } else { REACHED_M }
    }

    /// The root with the shortest route to a point of the mesh, and the length of that route, m.
    fn nearest_root(&self, mesh: &RouteMesh, at: MeshPoint) -> Option<(u32, f64)> {
        let [first, end] = [0, 1].map(|next| self.starts[at.triangle as usize + next] as usize);
        let mut best = (NONE, f64::INFINITY);
        for interval in &self.intervals[first..end] {
            if f64::from(interval.least_m) >= best.1 {
                break;
            }
            let root = &self.roots[interval.root as usize];
            let distance_m = root.distance_m + root.point_m.distance(at.point_m);
            if distance_m < best.1 && self.sees(mesh, interval, root, at.point_m) {
                best = (interval.root, distance_m);
            }
        }
        (best.0 != NONE).then_some(best)
    }

    fn sees(&self, mesh: &RouteMesh, interval: &FieldInterval, root: &FieldRoot, point_m: DVec2) -> bool {
        // Whether the line across a zone permits the point.
        let is_behind = |zone: u32| {
            let gates = mesh.gates.as_ref();
            gates.is_none_or(|gates| gates.ahead_m(zone, root.point_m, point_m) <= LEVEL_M)
        };
        let left_of_ray_m2 = |ray: u32| {
            let along_m = match ray {
                PARENT_RAY => root.point_m - self.roots[root.parent as usize].point_m,
                vertex => mesh.vertices_m[vertex as usize] - root.point_m,
            };
            along_m.perp_dot(point_m - root.point_m)
        };
        let permits = |ray: u32, sign: f64| match level_zone(ray) {
            Some(zone) => is_behind(zone),
            None => ray == NO_RAY || sign * left_of_ray_m2(ray) <= OUTSIDE_M2,
        };
        permits(interval.left, 1.0) && permits(interval.right, -1.0)
    }
}

impl RoutePosition {
    /// The point of the mesh at a position, and the same again where that lies off the mesh. Off the mesh it is the
    /// nearest point of the part that was remembered, so that no wall between two parts is passed.
    pub(crate) fn find(&mut self, mesh: &RouteMesh, position_m: DVec2) -> Option<(MeshPoint, Option<DVec2>)> {
        let remembered = Some(self.triangle).filter(|&triangle| (triangle as usize) < mesh.triangle_count());
        let walked = remembered.map(|triangle| mesh.walk(triangle, position_m));
        if let Some(Ok(triangle)) = walked {
            self.triangle = triangle;
            return Some((MeshPoint { triangle, point_m: position_m }, None));
        }
        let near = walked.and_then(Result::err);
        // Routes run along borders.
        let beside = near.map(|triangle| MeshPoint { triangle, point_m: mesh.nearest_in(triangle, position_m) });
        if let Some(beside) = beside.filter(|beside| beside.point_m.distance(position_m) < BESIDE_M) {
            self.triangle = beside.triangle;
            return Some((beside, None));
        }
        let part = near.map(|triangle| mesh.parts[triangle as usize]);
        let elsewhere = || mesh.triangle_at(position_m).map(|triangle| MeshPoint { triangle, point_m: position_m });
        let nearest = elsewhere().or_else(|| mesh.nearest(position_m, part, near))?;
        self.triangle = nearest.triangle;
        let is_off = nearest.point_m.distance(position_m) > BESIDE_M;
        Some((nearest, is_off.then_some(nearest.point_m)))
    }
}

impl RouteStep {
    /// The point to walk to from a position: the next corner; off the mesh, back onto it, leaning towards that corner.
    pub fn aim_m(&self, position_m: Vec2) -> Vec2 {
        let Some(entry_m) = self.entry_m else { return self.next_m };
        entry_m + (self.next_m - entry_m).normalize_or_zero() * entry_m.distance(position_m)
    }
}

/// The points of the mesh from which a goal is flooded, and the points of the goal that lie off the mesh beside them.
fn sources(mesh: &RouteMesh, goal: &RouteGoal) -> Vec<GoalSource> {
    let points_m = goal.flooded_points_m();
    let on_mesh = |&point_m: &DVec2| {
        let at = MeshPoint { triangle: mesh.triangle_at(point_m)?, point_m };
        Some(GoalSource { source: FloodSource { at, distance_m: 0.0 }, off_mesh_m: None })
    };
    let beside = |point_m: DVec2| {
        let at = mesh.nearest(point_m, None, None)?;
        let distance_m = at.point_m.distance(point_m);
        Some(GoalSource { source: FloodSource { at, distance_m }, off_mesh_m: Some(point_m) })
    };
    let is_area = !matches!(goal, RouteGoal::Points(_));
    let inside: Vec<GoalSource> = if is_area { points_m.iter().filter_map(on_mesh).collect() } else { Vec::new() };
    if !inside.is_empty() {
        return inside;
    }
    points_m.into_iter().filter_map(|point_m| on_mesh(&point_m).or_else(|| beside(point_m))).collect()
}

/// The cones by triangle, each triangle's in the order in which they were found; before them the index of each
/// triangle's first one, and their number.
fn intervals(mesh: &RouteMesh, found: &[FoundCone], slots: &[u32]) -> (Vec<u32>, Vec<FieldInterval>) {
    let mut starts = vec![0; mesh.triangle_count() + 1];
    for found in found {
        starts[found.triangle as usize + 1] += 1;
    }
    for triangle in 0..mesh.triangle_count() {
        starts[triangle + 1] += starts[triangle];
    }
    let mut next = starts.clone();
    let mut intervals = vec![FieldInterval { root: NONE, left: NO_RAY, right: NO_RAY, least_m: 0.0 }; found.len()];
    for &FoundCone { cone, triangle, least_m } in found {
        let ray = |ray| if ray == cone.root { PARENT_RAY } else { ray };
        let (left, right, least_m) = (ray(cone.left), ray(cone.right), (least_m as f32).next_down());
        let slot = &mut next[triangle as usize];
        intervals[*slot as usize] = FieldInterval { root: slots[cone.root as usize], left, right, least_m };
        *slot += 1;
    }
    (starts, intervals)
}

/// The roots that intervals use and those on their routes, and the slot of each root of the search.
fn roots(mesh: &RouteMesh, flood: &Flood, found: &[FoundCone], sources: &[GoalSource]) -> (Vec<FieldRoot>, Vec<u32>) {
    let (vertices, mut slots) = (mesh.vertex_count(), vec![NONE; flood.labels.len()]);
    for found in found {
        let mut root = found.cone.root;
        while root != NONE && std::mem::replace(&mut slots[root as usize], 0) == NONE {
            root = flood.labels[root as usize].parent;
        }
    }
    // All sources are kept, at the end.
    slots[vertices..].fill(0);
    let used: Vec<usize> = (0..slots.len()).filter(|&root| slots[root] != NONE).collect();
    for (slot, &root) in used.iter().enumerate() {
        slots[root] = slot as u32;
    }
    let off_mesh = |source: usize| {
        let before = sources[..source].iter().filter(|source| source.off_mesh_m.is_some()).count();
        sources[source].off_mesh_m.map_or(NONE, |_| (used.len() + before) as u32)
    };
    let root = |&root: &usize| {
        let label = flood.labels[root];
        let parent = root.checked_sub(vertices).map_or_else(|| slots[label.parent as usize], off_mesh);
        FieldRoot { point_m: flood.point_m(root as u32), distance_m: label.distance_m, parent }
    };
    let goals_m = sources.iter().filter_map(|source| source.off_mesh_m);
    let goals = goals_m.map(|point_m| FieldRoot { point_m, distance_m: 0.0, parent: NONE });
    (used.iter().map(root).chain(goals).collect(), slots)
}

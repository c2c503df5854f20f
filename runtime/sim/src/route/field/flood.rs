//! The search from a goal over the whole mesh: any-angle, in the order of distance.
//!
//! Polyanya (Cui, Harabor, Grastien 2017) from the goal instead of from the start. Two kinds of events wait in a queue,
//! the nearest first:
//!
//! 1. a *window*: what a root sees of a triangle through one of its edges. Its cone passes on through the triangle's
//!    other edges, and divides at the opposite corner if the root sees it;
//! 2. a *corner*: a vertex whose distance is final. It becomes the root of what the last stretch of its own route does
//!    not see: between that stretch, continued, and the border behind the corner.
//!
//! A window is dropped where an end of its edge is known to offer shorter routes ([`Span::is_dominated`]). All
//! decisions about sides are exact; lengths are f64. With a target, lengths to it are added (A*), and the search ends
//! when the target's distance is final.
//!
//! **One-way zones.** The search runs against the direction of agents, so a window passes a gate from its far end to its
//! near one. A corner at a gate is one vertex on each side; a route to the one beyond is one to the one before. Within a
//! zone a root sees only what lies behind it: the line through it across the heading limits its cones ([`LEVEL_RAY`]).
//! World, metres.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::route::field::interval::{Cone, LEVEL_RAY, NO_RAY, OUTSIDE_M2, Span, level_zone, meeting_point_m};
use crate::route::mesh::RouteMesh;
use crate::route::mesh::gates::LEVEL_M;
use crate::route::mesh::locate::{MeshPoint, nearest_on_edge};
use crate::route::mesh::route_mesh::side;
use crate::route::mesh::triangulation::NONE;

/// Mark of an event that is a corner, not a window.
const CORNER: u32 = 1 << 31;

/// A point from which the search starts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FloodSource {
    /// Its position on the mesh.
    pub(crate) at: MeshPoint,
    /// Distance from the goal itself, which may lie off the mesh, m.
    pub(crate) distance_m: f64,
}

/// The shortest route to a root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RootLabel {
    /// Length of the route, m.
    pub(crate) distance_m: f64,
    /// Index of the root before it; [`NONE`] of a source.
    pub(crate) parent: u32,
    /// Whether no shorter route can be found.
    is_final: bool,
}

/// What a root sees of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundCone {
    pub(crate) cone: Cone,
    pub(crate) triangle: u32,
    /// Lower bound of the lengths of routes to points of the triangle within the cone, m.
    pub(crate) least_m: f64,
}

/// What a root sees of a triangle through one of its edges.
#[derive(Clone, Copy, Debug)]
struct Window {
    found: FoundCone,
    edge: u32,
}

/// The search: its state, and after it its result.
pub(crate) struct Flood<'a> {
    mesh: &'a RouteMesh,
    target: Option<MeshPoint>,
    /// Positions of the vertices, then of the sources, m.
    points_m: Vec<DVec2>,
    /// Length of the shortest route to the target so far, m; infinite before the first.
    pub(crate) target_m: f64,
    /// The last root on that route; [`NONE`] before the first.
    pub(crate) target_root: u32,
    /// Labels of the vertices, then of the sources.
    pub(crate) labels: Vec<RootLabel>,
    /// Cones in the order of their lengths, save for those of the triangles in which sources lie; none with a target.
    pub(crate) found: Vec<FoundCone>,
    windows: Vec<Window>,
    /// Slots of `windows` that can be used again.
    unused: Vec<u32>,
    /// Events as bits of their lengths, which sort like the lengths, and indices.
    queue: BinaryHeap<Reverse<(u64, u32)>>,
}

impl<'a> Flood<'a> {
    /// Searches from sources, everywhere or until the distance of a target is final.
    pub(crate) fn run(mesh: &'a RouteMesh, sources: &[FloodSource], target: Option<MeshPoint>) -> Self {
        let unknown = RootLabel { distance_m: f64::INFINITY, parent: NONE, is_final: false };
        let of_source =
            |source: &FloodSource| RootLabel { distance_m: source.distance_m, parent: NONE, is_final: true };
        let labels = std::iter::repeat_n(unknown, mesh.vertex_count()).chain(sources.iter().map(of_source)).collect();
        let mut flood = Self {
            mesh,
            target,
            points_m: mesh.vertices_m.iter().copied().chain(sources.iter().map(|source| source.at.point_m)).collect(),
            target_m: f64::INFINITY,
            target_root: NONE,
            labels,
            found: Vec::new(),
            windows: Vec::new(),
            unused: Vec::new(),
            queue: BinaryHeap::new(),
        };
        for (index, source) in sources.iter().enumerate() {
            flood.start(source.at, (mesh.vertex_count() + index) as u32);
        }
        while let Some(Reverse((length, event))) = flood.queue.pop() {
            if f64::from_bits(length) >= flood.target_m {
                break;
            }
            if event & CORNER != 0 {
                flood.turn(event & !CORNER);
            } else {
                let window = flood.windows[event as usize];
                flood.unused.push(event);
                flood.pass(window);
            }
        }
        flood
    }

    /// Position of a vertex or source, m.
    pub(crate) fn point_m(&self, root: u32) -> DVec2 {
        self.points_m[root as usize]
    }

    /// Starts at a source: it sees all triangles that hold it, and through their other edges.
    fn start(&mut self, MeshPoint { triangle, point_m }: MeshPoint, root: u32) {
        let mut holding = vec![triangle];
        let mut at = 0;
        while let Some(&triangle) = holding.get(at) {
            at += 1;
            let (corners_m, neighbours) = (self.mesh.corners_m(triangle), self.mesh.neighbours[triangle as usize]);
            for edge in 0..3 {
                let ends_m = [corners_m[edge], corners_m[(edge + 1) % 3]];
                let faces = side(ends_m[0], ends_m[1], point_m) > 0.0;
                if !faces && neighbours[edge] != NONE && !holding.contains(&neighbours[edge]) {
                    holding.push(neighbours[edge]);
                }
                // On a gate, within rounding: agents come from before it too.
                if let Some([before, _]) = self.mesh.gates.as_ref().and_then(|gates| gates.before(triangle, edge))
                    && nearest_on_edge(point_m, ends_m[0], ends_m[1]).distance(point_m) < LEVEL_M
                    && !holding.contains(&before)
                {
                    holding.push(before);
                }
            }
        }
        for &triangle in &holding {
            let zone_ray = self.level_ray(triangle);
            let cone = Cone { root, left: zone_ray.unwrap_or(NO_RAY), right: zone_ray.unwrap_or(NO_RAY) };
            self.keep(FoundCone { cone, triangle, least_m: self.labels[root as usize].distance_m });
            let (vertices, neighbours) =
                (self.mesh.triangles[triangle as usize], self.mesh.neighbours[triangle as usize]);
            for edge in 0..3 {
                let [right, left] = [vertices[edge], vertices[(edge + 1) % 3]];
                if !self.is_ahead(triangle, root, right) {
                    self.reach(right, root);
                }
                if !holding.contains(&neighbours[edge])
                    && let Some(cone) = self.behind(Cone { root, left, right }, triangle)
                {
                    self.look(cone, triangle, edge);
                }
            }
        }
    }

    /// Event 1: a window's cone passes through its triangle.
    fn pass(&mut self, Window { found, edge }: Window) {
        self.keep(found);
        let FoundCone { cone, triangle, .. } = found;
        let apex = self.mesh.triangles[triangle as usize][(edge as usize + 2) % 3];
        let apex_m = self.point_m(apex);
        let [from_left, from_right] = self.sides_of_rays(cone, apex_m);
        if from_left <= 0.0 && from_right >= 0.0 {
            self.reach(apex, cone.root);
        }
        if from_left < 0.0 {
            let right = if from_right > 0.0 { apex } else { cone.right };
            self.look(Cone { right, ..cone }, triangle, (edge as usize + 2) % 3);
        }
        if from_right > 0.0 {
            let left = if from_left < 0.0 { apex } else { cone.left };
            self.look(Cone { left, ..cone }, triangle, (edge as usize + 1) % 3);
        }
    }

    /// Event 2: a corner whose distance is final sees what its parent does not see. Cases:
    ///
    /// 1. the border behind the corner lies to the left of the route's last stretch: all between this, continued, and
    ///    the last edge of the fan;
    /// 2. it lies to the right: all between the first edge of the fan and the stretch, continued;
    /// 3. it lies ahead: nothing.
    fn turn(&mut self, corner: u32) {
        let label = &mut self.labels[corner as usize];
        if std::mem::replace(&mut label.is_final, true) {
            return;
        }
        let (mesh, from_m, corner_m) =
            (self.mesh, self.point_m(self.labels[corner as usize].parent), self.point_m(corner));
        let ends = |triangle: u32| {
            let (vertices, at) = (mesh.triangles[triangle as usize], mesh.corner_of(triangle, corner));
            [vertices[(at + 1) % 3], vertices[(at + 2) % 3]]
        };
        let beside = |vertex: u32| side(from_m, corner_m, mesh.vertices_m[vertex as usize]);
        for &triangle in mesh.fan(corner).iter().rev() {
            let [right, left] = ends(triangle);
            if beside(left) <= 0.0 {
                break;
            }
            let partly = beside(right) < 0.0;
            self.see_around(corner, triangle, Cone { root: corner, left, right: if partly { corner } else { right } });
        }
        for &triangle in mesh.fan(corner) {
            let [right, left] = ends(triangle);
            if beside(right) >= 0.0 {
                break;
            }
            let partly = beside(left) > 0.0;
            self.see_around(corner, triangle, Cone { root: corner, left: if partly { corner } else { left }, right });
        }
    }

    /// A corner sees a triangle around it, or a part of it beside the ray on which the route came.
    fn see_around(&mut self, corner: u32, triangle: u32, cone: Cone) {
        let Some(behind) = self.behind(cone, triangle) else { return };
        let limit = |ray| if ray == corner || level_zone(ray).is_some() { ray } else { NO_RAY };
        let inside = Cone { left: limit(behind.left), right: limit(behind.right), ..cone };
        let least_m = self.labels[corner as usize].distance_m;
        self.keep(FoundCone { cone: inside, triangle, least_m });
        for vertex in [behind.left, behind.right].into_iter().filter(|&ray| ray != corner && level_zone(ray).is_none())
        {
            self.reach(vertex, corner);
        }
        self.look(behind, triangle, (self.mesh.corner_of(triangle, corner) + 1) % 3);
    }

    /// The line across the heading of the zone in which a triangle lies.
    fn level_ray(&self, triangle: u32) -> Option<u32> {
        Some(LEVEL_RAY - self.mesh.gates.as_ref()?.zone(triangle)?)
    }

    /// Whether a vertex lies ahead of a root in the zone of a triangle.
    fn is_ahead(&self, triangle: u32, root: u32, vertex: u32) -> bool {
        let ahead_m = self.mesh.gates.as_ref().and_then(|gates| {
            let zone = gates.zone(triangle)?;
            Some(gates.ahead_m(zone, self.point_m(root), self.point_m(vertex)))
        });
        ahead_m.is_some_and(|ahead_m| ahead_m > LEVEL_M)
    }

    /// A cone that begins in a triangle, without what lies ahead of its root in a one-way zone.
    fn behind(&self, cone: Cone, triangle: u32) -> Option<Cone> {
        let Some(level) = self.level_ray(triangle) else { return Some(cone) };
        let is_ahead = |ray: u32| ray != cone.root && self.is_ahead(triangle, cone.root, ray);
        let limit = |ray| if is_ahead(ray) { level } else { ray };
        let (left, right) = (limit(cone.left), limit(cone.right));
        (left != level || right != level).then_some(Cone { left, right, ..cone })
    }

    /// Finds a route to a vertex that a root sees.
    fn reach(&mut self, vertex: u32, root: u32) {
        let vertex_m = self.point_m(vertex);
        let distance_m = self.labels[root as usize].distance_m + vertex_m.distance(self.point_m(root));
        let label = &mut self.labels[vertex as usize];
        if label.is_final || distance_m >= label.distance_m {
            return;
        }
        (label.distance_m, label.parent) = (distance_m, root);
        if self.mesh.is_corner[vertex as usize] {
            let rest_m = self.target.map_or(0.0, |target| target.point_m.distance(vertex_m));
            self.queue.push(Reverse(((distance_m + rest_m).to_bits(), vertex | CORNER)));
        }
        if let Some(gates) = self.mesh.gates.as_ref() {
            gates.vertices_before(vertex).for_each(|before| self.reach(before, root));
        }
    }

    /// A cone looks out of a triangle through one of its edges.
    fn look(&mut self, cone: Cone, triangle: u32, edge: usize) {
        let neighbour = self.mesh.neighbours[triangle as usize][edge];
        let (beyond, edge) = if neighbour != NONE {
            (neighbour, self.mesh.edge_to(neighbour, triangle))
        } else if let Some([before, edge]) = self.mesh.gates.as_ref().and_then(|gates| gates.before(triangle, edge)) {
            (before, edge as usize)
        } else {
            return;
        };
        let vertices = self.mesh.triangles[beyond as usize];
        let ends = [vertices[edge], vertices[(edge + 1) % 3]];
        let span = self.span(cone, ends);
        if span.is_dominated(self.lengths_along_m(beyond, ends)) {
            return;
        }
        let least_m = span.least_m();
        let length_m = self.target.map_or(least_m, |target| span.least_to_m(target.point_m));
        let window = Window { found: FoundCone { cone, triangle: beyond, least_m }, edge: edge as u32 };
        let slot = self.unused.pop().unwrap_or(self.windows.len() as u32);
        if slot as usize == self.windows.len() {
            self.windows.push(window);
        } else {
            self.windows[slot as usize] = window;
        }
        self.queue.push(Reverse((length_m.to_bits(), slot)));
    }

    /// Lengths of the routes from the ends of an edge, m; infinite where agents in the triangle do not walk along the edge
    /// to that end, against the heading of its zone.
    fn lengths_along_m(&self, triangle: u32, ends: [u32; 2]) -> [f64; 2] {
        let lengths_m = ends.map(|end| self.labels[end as usize].distance_m);
        let Some((gates, zone)) = self.mesh.gates.as_ref().and_then(|gates| Some((gates, gates.zone(triangle)?)))
        else {
            return lengths_m;
        };
        let ahead_m = gates.ahead_m(zone, self.point_m(ends[1]), self.point_m(ends[0]));
        [
            if ahead_m < 0.0 { f64::INFINITY } else { lengths_m[0] },
            if ahead_m > 0.0 { f64::INFINITY } else { lengths_m[1] },
        ]
    }

    /// Keeps what a root sees. With a target, only the shortest route to that is kept.
    fn keep(&mut self, found: FoundCone) {
        let Some(target) = self.target else { return self.found.push(found) };
        let Cone { root, left, right } = found.cone;
        if found.triangle != target.triangle {
            return;
        }
        let [from_left, from_right] = self.sides_of_rays(found.cone, target.point_m);
        let outside_m2 = |ray| if level_zone(ray).is_some() { LEVEL_M } else { OUTSIDE_M2 };
        let is_seen =
            (left == NO_RAY || from_left <= outside_m2(left)) && (right == NO_RAY || from_right >= -outside_m2(right));
        if is_seen {
            let length_m = self.labels[root as usize].distance_m + self.point_m(root).distance(target.point_m);
            if length_m < self.target_m {
                (self.target_m, self.target_root) = (length_m, root);
            }
        }
    }

    /// The stretch of an edge that a cone covers, given the ends of the edge, the left one first.
    fn span(&self, Cone { root, left, right }: Cone, ends: [u32; 2]) -> Span {
        let (root_m, edge_m) = (self.point_m(root), ends.map(|end| self.point_m(end)));
        let meet = |ray: u32, end: usize| {
            if ray == ends[end] {
                return edge_m[end];
            }
            let direction_m = level_zone(ray).zip(self.mesh.gates.as_ref()).map_or_else(
                || self.direction_m(root, ray),
                |(zone, gates)| gates.headings[zone as usize].perp() * if end == 0 { -1.0 } else { 1.0 },
            );
            meeting_point_m(root_m, direction_m, edge_m)
        };
        let ends_m = [meet(left, 0), meet(right, 1)];
        Span { root_m, distance_m: self.labels[root as usize].distance_m, edge_m, ends_m }
    }

    /// For the left and the right ray of a cone: positive where a point lies left of it. The signs are exact, save for
    /// the line across a zone; there the number is the distance beyond it, m.
    fn sides_of_rays(&self, Cone { root, left, right }: Cone, point_m: DVec2) -> [f64; 2] {
        [(left, 1.0), (right, -1.0)].map(|(ray, sign)| match level_zone(ray).zip(self.mesh.gates.as_ref()) {
            Some((zone, gates)) => sign * gates.ahead_m(zone, self.point_m(root), point_m),
            None if ray == NO_RAY => 0.0,
            None => self.side_of_ray(root, ray, point_m),
        })
    }

    /// Positive where a point lies left of a ray of a root. The sign is exact.
    fn side_of_ray(&self, root: u32, ray: u32, point_m: DVec2) -> f64 {
        let root_m = self.point_m(root);
        if ray == root {
            return side(self.point_m(self.labels[root as usize].parent), root_m, point_m);
        }
        side(root_m, self.point_m(ray), point_m)
    }

    fn direction_m(&self, root: u32, ray: u32) -> DVec2 {
        let root_m = self.point_m(root);
        if ray == root { root_m - self.point_m(self.labels[root as usize].parent) } else { self.point_m(ray) - root_m }
    }
}

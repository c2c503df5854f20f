//! Edges of a surface collapse onto one of their ends, the least error first. World, metres.
//!
//! Point `from` moves onto point `onto`. Each wedge of `from` becomes the wedge of `onto` that a common triangle shows: so
//! texture coordinates stay on their chart, and a seam collapses along itself alone. Collapses run in passes; those of one
//! pass do not touch each other, so their order does not matter.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::detail::example_poses::POSES;
use crate::detail::quadric::{AttributeQuadric, Quadric};
use crate::detail::surface::Surface;

/// Length that counts as much as the whole range of a linear colour, m: where two centimetres are not seen, neither is a
/// tenth of a colour.
const COLOUR_M: f64 = 0.2;
/// Weight of borders and seams: squared length of an edge over area of a triangle.
const BORDER_WEIGHT: f64 = 1.0;
/// Least cosine of the angle by which a triangle turns in a collapse.
const LEAST_TURN_COS: f64 = 0.3;
/// Twice the area of a triangle over the square of its longest edge below which rounding decides where it faces.
const THIN: f64 = 1e-3;
/// Greatest number of triangles around both points of a collapse: a hub of thousands stays as it is.
const AROUND_MAX: usize = 96;
/// Greatest number of points that are looked at together.
const POINTS_AT_ONCE: usize = 1024;

/// A surface that loses points step by step.
pub(super) struct Reduction<'a> {
    pub(super) surface: Surface,
    /// Normal of each vertex of the mesh, bind space.
    normals: &'a [Vec3],
    is_left: Vec<bool>,
    /// Triangles around each point, those that are gone included until the point changes.
    around: Vec<Vec<u32>>,
    /// Squared distances to the planes that a point stands for, by poses, times area.
    planes: Vec<[Quadric; POSES]>,
    /// Area that a point stands for, m².
    areas_m2: Vec<f64>,
    /// Differences of attributes that a wedge stands for, and its area.
    attributes: Vec<(AttributeQuadric, f64)>,
    /// The best collapse of each point.
    best: Vec<Option<Collapse>>,
    changed: Vec<bool>,
}

/// A collapse of a point.
#[derive(Clone, Copy, Debug)]
struct Collapse {
    /// Mean squared error, m².
    error_m2: f64,
    onto: u32,
}

impl<'a> Reduction<'a> {
    pub(super) fn new(surface: Surface, normals: &'a [Vec3]) -> Self {
        let [points, wedges] = surface.counts;
        let mut around = vec![Vec::new(); points];
        for triangle in 0..surface.triangles.len() {
            for point in surface.corner_points(triangle) {
                around[point as usize].push(triangle as u32);
            }
        }
        let mut new = Self {
            is_left: vec![true; surface.triangles.len()],
            around,
            planes: vec![[Quadric::default(); POSES]; points],
            areas_m2: vec![0.0; points],
            attributes: vec![Default::default(); wedges],
            best: vec![None; points],
            changed: vec![true; points],
            surface,
            normals,
        };
        (0..new.surface.triangles.len()).for_each(|triangle| new.add_triangle(triangle));
        new.add_borders();
        new
    }

    /// Collapses all that cost at most this error, m.
    pub(super) fn reduce(&mut self, error_m: f64) {
        let limit_m2 = error_m * error_m;
        loop {
            self.look_again();
            let cheap = self.best.iter().enumerate().filter_map(|(from, best)| {
                best.filter(|collapse| collapse.error_m2 <= limit_m2).map(|collapse| (from as u32, collapse))
            });
            let mut cheap: Vec<(u32, Collapse)> = cheap.collect();
            if cheap.is_empty() {
                return;
            }
            cheap.sort_by(|(one, a), (other, b)| a.error_m2.total_cmp(&b.error_m2).then(one.cmp(other)));
            for (from, collapse) in cheap {
                // A change beside it: the next pass decides again.
                if !self.changed[from as usize] && !self.changed[collapse.onto as usize] {
                    self.collapse(from, collapse.onto);
                }
            }
        }
    }

    /// The triangles that are left.
    pub(super) fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.is_left.len()).filter(|triangle| self.is_left[*triangle])
    }

    fn add_triangle(&mut self, triangle: usize) {
        let points = self.surface.corner_points(triangle);
        let corners_m = points.map(|point| self.surface.positions_m[point as usize]);
        let area_m2 = 0.5 * across(corners_m.map(|poses_m| poses_m[0])).length();
        for pose in 0..POSES {
            let of_pose_m = corners_m.map(|poses_m| poses_m[pose]);
            let Some(normal) = across(of_pose_m).try_normalize() else { continue };
            let plane = Quadric::of_plane(normal, of_pose_m[0], area_m2 / 3.0);
            points.iter().for_each(|point| self.planes[*point as usize][pose].add(&plane));
        }
        let wedges = self.surface.corner_wedges(triangle);
        let attributes = wedges.map(|wedge| self.surface.attributes[wedge as usize]);
        let rest_m = corners_m.map(|poses_m| poses_m[0]);
        let scale_m = match self.surface.is_textured.get(self.surface.materials[triangle] as usize) {
            Some(true) => texture_scale_m(rest_m, attributes),
            _ => COLOUR_M,
        };
        let weight = area_m2 / 3.0 * scale_m * scale_m;
        let difference = AttributeQuadric::of_triangle(rest_m, attributes, weight);
        for (point, wedge) in points.into_iter().zip(wedges) {
            self.areas_m2[point as usize] += area_m2 / 3.0;
            let (sum, area) = &mut self.attributes[wedge as usize];
            sum.add(&difference);
            *area += area_m2 / 3.0;
        }
    }

    /// Holds points on the edges that not exactly two triangles share with the same wedges.
    fn add_borders(&mut self) {
        let mut edges: Vec<([u32; 4], u32)> = Vec::with_capacity(3 * self.surface.triangles.len());
        for triangle in 0..self.surface.triangles.len() {
            let (points, wedges) = (self.surface.corner_points(triangle), self.surface.corner_wedges(triangle));
            edges.extend([(0, 1), (1, 2), (2, 0)].map(|(first, second)| {
                let (first, second) = if points[first] < points[second] { (first, second) } else { (second, first) };
                ([points[first], points[second], wedges[first], wedges[second]], triangle as u32)
            }));
        }
        edges.sort_unstable();
        for run in edges.chunk_by(|(one, _), (other, _)| one == other).filter(|run| run.len() != 2) {
            run.iter().for_each(|([first, second, ..], triangle)| self.add_border([*first, *second], *triangle));
        }
    }

    fn add_border(&mut self, ends: [u32; 2], triangle: u32) {
        let points = self.surface.corner_points(triangle as usize);
        for pose in 0..POSES {
            let at_m = |point: u32| self.surface.positions_m[point as usize][pose];
            let edge_m = at_m(ends[1]) - at_m(ends[0]);
            let Some(outward) = edge_m.cross(across(points.map(at_m))).try_normalize() else { continue };
            let plane = Quadric::of_plane(outward, at_m(ends[0]), BORDER_WEIGHT * edge_m.length_squared());
            ends.iter().for_each(|point| self.planes[*point as usize][pose].add(&plane));
        }
    }

    /// Finds the best collapse of each point beside which something changed.
    fn look_again(&mut self) {
        let mut best = std::mem::take(&mut self.best);
        best.par_chunks_mut(POINTS_AT_ONCE).enumerate().for_each(|(chunk, best)| {
            for (offset, best) in best.iter_mut().enumerate() {
                let from = chunk * POINTS_AT_ONCE + offset;
                if self.changed[from] {
                    *best = self.best_collapse(from as u32);
                }
            }
        });
        self.best = best;
        self.changed.fill(false);
    }

    fn triangles_around(&self, point: u32) -> impl Iterator<Item = usize> {
        let around = self.around[point as usize].iter().map(|triangle| *triangle as usize);
        around.filter(|triangle| self.is_left[*triangle])
    }

    fn best_collapse(&self, from: u32) -> Option<Collapse> {
        if self.around[from as usize].len() > AROUND_MAX {
            return None;
        }
        let beside = self.beside(from);
        let collapse = |onto: u32| Some(Collapse { error_m2: self.error_m2(from, onto)?, onto });
        let mut collapses: Vec<Collapse> = beside.iter().copied().filter_map(collapse).collect();
        collapses.sort_by(|one, other| one.error_m2.total_cmp(&other.error_m2).then(one.onto.cmp(&other.onto)));
        let is_allowed = |onto: u32| self.keeps_sides(from, onto) && self.keeps_topology(from, &beside, onto);
        collapses.into_iter().find(|collapse| is_allowed(collapse.onto))
    }

    /// The points that share a triangle with a point, rising.
    fn beside(&self, point: u32) -> Vec<u32> {
        let corners = self.triangles_around(point).flat_map(|triangle| self.surface.corner_points(triangle));
        let mut beside: Vec<u32> = corners.filter(|corner| *corner != point).collect();
        beside.sort_unstable();
        beside.dedup();
        beside
    }

    /// Whether both points have no common neighbours but the corners of their common triangles (link condition, Dey et al.
    /// 1999): else a thin part, as hair over a head, would fold flat and vanish.
    fn keeps_topology(&self, from: u32, beside: &[u32], onto: u32) -> bool {
        let common = self.beside(onto).into_iter().filter(|point| beside.binary_search(point).is_ok()).count();
        let shared = self.triangles_around(from).map(|triangle| self.surface.corner_points(triangle));
        let mut corners: Vec<u32> = shared.filter(|points| points.contains(&onto)).flatten().collect();
        corners.sort_unstable();
        corners.dedup();
        // Both points are corners, too.
        common + 2 == corners.len()
    }

    /// Greatest mean squared error of a collapse, m²: of planes in any pose, of attributes of any wedge; none where a
    /// wedge would leave its chart.
    fn error_m2(&self, from: u32, onto: u32) -> Option<f64> {
        if self.around[from as usize].len() + self.around[onto as usize].len() > AROUND_MAX {
            return None;
        }
        let wedges = self.wedge_pairs(from, onto)?;
        let onto_m = &self.surface.positions_m[onto as usize];
        let planes = self.planes[from as usize].iter().zip(onto_m).map(|(planes, onto_m)| planes.at(*onto_m));
        let of_planes = planes.fold(0.0, f64::max) / self.areas_m2[from as usize].max(f64::MIN_POSITIVE);
        let of_attributes = wedges.iter().map(|[own, other]| {
            let (difference, area) = &self.attributes[*own as usize];
            difference.at(onto_m[0], self.surface.attributes[*other as usize]) / area.max(f64::MIN_POSITIVE)
        });
        Some(of_attributes.fold(of_planes, f64::max)).filter(|error_m2| error_m2.is_finite())
    }

    /// Each wedge around a point with the wedge of the other point that a common triangle shows; none where there is no
    /// such triangle, or two differ.
    fn wedge_pairs(&self, from: u32, onto: u32) -> Option<Vec<[u32; 2]>> {
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for triangle in self.triangles_around(from) {
            let points = self.surface.corner_points(triangle);
            let Some(other) = points.iter().position(|point| *point == onto) else { continue };
            let own = points.iter().position(|point| *point == from)?;
            let wedges = self.surface.corner_wedges(triangle);
            match pairs.iter().find(|pair| pair[0] == wedges[own]) {
                Some(pair) if pair[1] != wedges[other] => return None,
                Some(_) => (),
                None => pairs.push([wedges[own], wedges[other]]),
            }
        }
        let is_paired = |triangle: usize| {
            let (points, wedges) = (self.surface.corner_points(triangle), self.surface.corner_wedges(triangle));
            (0..3).all(|corner| points[corner] != from || pairs.iter().any(|pair| pair[0] == wedges[corner]))
        };
        self.triangles_around(from).all(is_paired).then_some(pairs)
    }

    /// Whether all triangles that stay still face where they did, in all poses.
    fn keeps_sides(&self, from: u32, onto: u32) -> bool {
        self.triangles_around(from).all(|triangle| {
            let points = self.surface.corner_points(triangle);
            if points.contains(&onto) {
                return true;
            }
            let moved = points.map(|point| if point == from { onto } else { point });
            (0..POSES).all(|pose| {
                let at_m = |point: u32| self.surface.positions_m[point as usize][pose];
                let [before_m, after_m] = [points, moved].map(|points| points.map(at_m));
                let [before, after] = [before_m, after_m].map(across);
                // A triangle without area has no side: it may get one, and none may lose it.
                is_thin(before_m)
                    || !is_thin(after_m) && before.dot(after) > LEAST_TURN_COS * before.length() * after.length()
            })
        })
    }

    fn collapse(&mut self, from: u32, onto: u32) {
        let Some(pairs) = self.wedge_pairs(from, onto) else { return };
        for [own, other] in &pairs {
            let (difference, area) = self.attributes[*own as usize];
            let (sum, sum_area) = &mut self.attributes[*other as usize];
            sum.add(&difference);
            *sum_area += area;
        }
        let planes = self.planes[from as usize];
        self.planes[onto as usize].iter_mut().zip(planes).for_each(|(own, other)| own.add(&other));
        self.areas_m2[onto as usize] += self.areas_m2[from as usize];
        let vertices = self.vertices_of(onto);
        let moved: Vec<usize> = self.triangles_around(from).collect();
        for triangle in moved {
            let points = self.surface.corner_points(triangle);
            if points.contains(&onto) {
                self.is_left[triangle] = false;
                continue;
            }
            self.surface.triangles[triangle] = self.surface.triangles[triangle].map(|vertex| {
                let is_moved = self.surface.points[vertex as usize] == from;
                if is_moved { self.replacement(vertex, &pairs, &vertices) } else { vertex }
            });
            self.around[onto as usize].push(triangle as u32);
        }
        self.around[from as usize].clear();
        let is_left = &self.is_left;
        self.around[onto as usize].retain(|triangle| is_left[*triangle as usize]);
        self.best[from as usize] = None;
        self.mark_changed(onto);
    }

    /// The vertices of a point that triangles show.
    fn vertices_of(&self, point: u32) -> Vec<u32> {
        let corners = self.triangles_around(point).flat_map(|triangle| self.surface.triangles[triangle]);
        let mut vertices: Vec<u32> = corners.filter(|corner| self.surface.points[*corner as usize] == point).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Of the vertices of the paired wedge, that with the nearest normal.
    fn replacement(&self, vertex: u32, pairs: &[[u32; 2]], vertices: &[u32]) -> u32 {
        let wedge_of = |vertex: u32| self.surface.wedges[vertex as usize];
        let wedge = pairs.iter().find(|pair| pair[0] == wedge_of(vertex)).map(|pair| pair[1]);
        let normal = self.normals[vertex as usize];
        let likeness = |other: &&u32| normal.dot(self.normals[**other as usize]);
        let of_wedge = vertices.iter().filter(|other| Some(wedge_of(**other)) == wedge);
        of_wedge.max_by(|one, other| likeness(one).total_cmp(&likeness(other))).copied().unwrap_or(vertex)
    }

    /// Marks a point and all beside it.
    fn mark_changed(&mut self, point: u32) {
        let triangles: Vec<usize> = self.triangles_around(point).collect();
        self.changed[point as usize] = true;
        for beside in triangles.into_iter().flat_map(|triangle| self.surface.corner_points(triangle)) {
            self.changed[beside as usize] = true;
        }
    }
}

/// The normal of a triangle, as long as twice its area.
fn across(corners_m: [DVec3; 3]) -> DVec3 {
    (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0])
}

/// Whether the corners lie nearly on a line.
fn is_thin(corners_m: [DVec3; 3]) -> bool {
    let longest_m2 = (0..3).map(|from| corners_m[from].distance_squared(corners_m[(from + 1) % 3])).fold(0.0, f64::max);
    across(corners_m).length() <= THIN * longest_m2
}

/// Metres on a triangle for a unit of its texture coordinates; 0 where they do not change.
fn texture_scale_m(corners_m: [DVec3; 3], uvs: [DVec3; 3]) -> f64 {
    let around = |corners: [DVec3; 3]| (0..3).map(|from| corners[from].distance(corners[(from + 1) % 3])).sum::<f64>();
    let around_uv = around(uvs);
    if around_uv > 0.0 { around(corners_m) / around_uv } else { 0.0 }
}

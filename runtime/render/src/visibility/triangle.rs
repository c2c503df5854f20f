//! Triangles in the picture: clipped at the near plane and far beside the picture, then edge functions in exact
//! integers, so that neighbours with a common edge leave no gap.
//!
//! Positions are in units of 1/256 pixel. In perspective 1/depth, in orthographic projection depth, is linear in (u, v).

use glam::{Vec2, Vec3};

use crate::visibility::lens::{Lens, NEAR_M};
use crate::visibility::sample_pattern::{SamplePattern, UNITS};

/// Edges of the picture's frustum are widened by this factor before triangles are cut: then few are, and coordinates
/// stay small.
const GUARD: f32 = 8.0;
/// Greatest number of corners of a clipped triangle: one more for each plane.
const CORNERS_MAX: usize = 8;

/// A triangle in the picture, ready to be tested at samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScreenTriangle {
    /// Index of the triangle in the scene.
    pub(crate) index: u32,
    /// Corners in units, counter-clockwise or clockwise such that all edge functions are positive inside.
    corners: [[i32; 2]; 3],
    /// 1/depth or depth as a·u + b·v + c.
    depth: Vec3,
    is_perspective: bool,
}

/// Edge functions of a triangle along one tile: value at a sample, and change per unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    origin: [i32; 2],
    step: [i64; 2],
}

/// Appends a triangle's visible parts, in camera space.
pub(crate) fn append_visible(out: &mut Vec<ScreenTriangle>, index: u32, corners_m: [Vec3; 3], lens: &Lens) {
    let half = 0.5 * lens.size() * lens.pixel * GUARD;
    let is_in_front = corners_m.iter().all(|corner| corner.z >= NEAR_M);
    let is_near_picture = |corner: &Vec3| {
        let depth = if lens.is_perspective { corner.z } else { 1.0 };
        (corner.truncate().abs() - half * depth).max_element() <= 0.0
    };
    if is_in_front && corners_m.iter().all(is_near_picture) {
        out.extend(ScreenTriangle::new(index, corners_m, corners_m, lens));
        return;
    }
    let mut polygon = Polygon { corners: [Vec3::ZERO; CORNERS_MAX], count: 3 };
    polygon.corners[..3].copy_from_slice(&corners_m);
    polygon.clip(|corner| corner.z - NEAR_M);
    for axis in [0, 1] {
        for sign in [-1.0, 1.0] {
            let depth = |corner: Vec3| if lens.is_perspective { corner.z } else { 1.0 };
            polygon.clip(|corner| half[axis] * depth(corner) - sign * corner[axis]);
        }
    }
    for last in 2..polygon.count {
        let part = [polygon.corners[0], polygon.corners[last - 1], polygon.corners[last]];
        out.extend(ScreenTriangle::new(index, part, corners_m, lens));
    }
}

/// A convex polygon in camera space.
struct Polygon {
    corners: [Vec3; CORNERS_MAX],
    count: usize,
}

impl Polygon {
    /// Keeps the side on which `inside` is not negative (Sutherland and Hodgman 1974).
    fn clip(&mut self, inside: impl Fn(Vec3) -> f32) {
        let (corners, count) = (self.corners, self.count);
        self.count = 0;
        for index in 0..count {
            let (from, to) = (corners[index], corners[(index + 1) % count]);
            let (at_from, at_to) = (inside(from), inside(to));
            if at_from >= 0.0 {
                self.push(from);
            }
            if (at_from >= 0.0) != (at_to >= 0.0) {
                self.push(from.lerp(to, at_from / (at_from - at_to)));
            }
        }
    }

    fn push(&mut self, corner: Vec3) {
        if self.count < CORNERS_MAX {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

impl ScreenTriangle {
    /// A part of a triangle; depths are those of the whole triangle's plane. None without area.
    fn new(index: u32, part_m: [Vec3; 3], corners_m: [Vec3; 3], lens: &Lens) -> Option<Self> {
        let mut corners = part_m.map(|corner| {
            let depth = if lens.is_perspective { corner.z } else { 1.0 };
            let px = corner.truncate() / (depth * lens.pixel) + 0.5 * lens.size();
            let units = px * UNITS as f32;
            [units.x.round() as i32, units.y.round() as i32]
        });
        let edge = |from: [i32; 2], to: [i32; 2]| [i64::from(to[0] - from[0]), i64::from(to[1] - from[1])];
        let (first, second) = (edge(corners[0], corners[1]), edge(corners[0], corners[2]));
        let area = first[0] * second[1] - first[1] * second[0];
        if area == 0 {
            return None;
        }
        if area < 0 {
            corners.swap(1, 2);
        }
        // The plane n·x = k, with x = depth·(u, v, 1) or (u, v, depth).
        let normal = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]);
        let level = normal.dot(corners_m[0]);
        let depth =
            if lens.is_perspective { normal / level } else { Vec3::new(-normal.x, -normal.y, level) / normal.z };
        depth.is_finite().then_some(Self { index, corners, depth, is_perspective: lens.is_perspective })
    }

    /// First and last pixel (inclusive) of columns and rows, within the picture; none without a pixel.
    pub(crate) fn bounds(&self, size_px: [u32; 2]) -> Option<[[u32; 2]; 2]> {
        let mut bounds = [[0; 2]; 2];
        for axis in [0, 1] {
            let along = self.corners.map(|corner| corner[axis]);
            let low = along[0].min(along[1]).min(along[2]).div_euclid(UNITS).max(0);
            let high = along[0].max(along[1]).max(along[2]).div_euclid(UNITS).min(size_px[axis] as i32 - 1);
            if low > high {
                return None;
            }
            bounds[0][axis] = low as u32;
            bounds[1][axis] = high as u32;
        }
        Some(bounds)
    }

    /// Whether a sample lies in the box around the triangle: most triangles of a distant body hold none.
    pub(crate) fn may_hold_sample(&self, pattern: SamplePattern) -> bool {
        let range = |axis: usize| {
            let along = self.corners.map(|corner| corner[axis]);
            [along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2])]
        };
        let (columns, rows) = (range(0), range(1));
        // The first sample that is not before the box is not behind it.
        let holds = |[low, high]: [i32; 2], offset: i32| {
            (low - offset - 1).div_euclid(UNITS) < (high - offset).div_euclid(UNITS)
        };
        let is_large = columns[1] - columns[0] >= UNITS && rows[1] - rows[0] >= UNITS;
        is_large || pattern.offsets().iter().any(|offset| holds(columns, offset[0]) && holds(rows, offset[1]))
    }

    /// The three edge functions.
    pub(crate) fn edges(&self) -> [Edge; 3] {
        [0, 1, 2].map(|index| {
            let (from, to) = (self.corners[index], self.corners[(index + 1) % 3]);
            Edge { origin: from, step: [i64::from(from[1] - to[1]), i64::from(to[0] - from[0])] }
        })
    }

    /// Depth at (u, v), m.
    #[inline]
    pub(crate) fn depth_m(&self, uv: Vec2) -> f32 {
        let linear = self.depth.x * uv.x + self.depth.y * uv.y + self.depth.z;
        if self.is_perspective { 1.0 / linear } else { linear }
    }
}

impl Edge {
    /// Change over a number of units along x.
    pub(crate) fn step(&self, units: i32) -> i64 {
        self.step[0] * i64::from(units)
    }

    /// Change over a number of units along y.
    pub(crate) fn step_down(&self, units: i32) -> i64 {
        self.step[1] * i64::from(units)
    }

    /// Value at a position in units: not negative inside.
    #[inline]
    pub(crate) fn at(&self, position: [i32; 2]) -> i64 {
        i64::from(position[0] - self.origin[0]) * self.step[0] + i64::from(position[1] - self.origin[1]) * self.step[1]
    }
}

/// Weights of a triangle's corners at a point of its plane; none is negative.
pub(crate) fn weights(corners_m: [Vec3; 3], point_m: Vec3) -> Vec3 {
    let [a, b, c] = corners_m;
    let normal = (b - a).cross(c - a);
    let part = |from: Vec3, to: Vec3| (to - from).cross(point_m - from).dot(normal).max(0.0);
    let parts = Vec3::new(part(b, c), part(c, a), part(a, b));
    let sum = parts.element_sum();
    if sum > 0.0 { parts / sum } else { Vec3::splat(1.0 / 3.0) }
}

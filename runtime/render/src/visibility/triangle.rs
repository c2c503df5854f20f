//! Triangles in the picture: clipped at the near plane and far beside the picture, then edge functions in exact
//! integers, so that neighbours with a common edge leave no gap.
//!
//! Positions are in units of 1/256 pixel. In perspective 1/depth, in orthographic projection depth, is linear in (u, v).

use std::ops::{Add, BitOr, Mul};

use glam::{Vec2, Vec3};

use crate::visibility::lens::{Lens, NEAR_M};
use crate::visibility::sample_pattern::{SamplePattern, UNITS};
use crate::visibility::screen_bounds::PixelBounds;

/// Edges of the picture's frustum are widened by this factor before triangles are cut: then few are, and coordinates
/// stay small.
const GUARD: f32 = 8.0;
/// Greatest side of the box around a triangle whose edge functions fit `i32`, units: 62 pixels. With the pixels that it
/// touches the box has less than 2¹⁴, so that both products are less than 2²⁸.
const SMALL_UNITS: i32 = 62 * UNITS;
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
}

/// Edge function of a triangle: not negative inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    origin: [i32; 2],
    /// Change per unit along x and y.
    step: [i32; 2],
}

/// How triangles become those of the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<'a> {
    pub(crate) lens: &'a Lens,
    pub(crate) pattern: SamplePattern,
    /// First line that is drawn, and the one after the last.
    pub(crate) lines: [i32; 2],
}

/// Position of a vertex that lies before the near plane or far beside the picture.
pub(crate) const FAR: [i32; 2] = [i32::MIN; 2];

/// Position of a point of the world in the picture, units; [`FAR`] where its triangles are to be clipped.
pub(crate) fn screen_position(point_m: Vec3, lens: &Lens) -> [i32; 2] {
    let camera_m = lens.to_camera(point_m);
    let beside = (camera_m.truncate().abs() - guard(lens) * depth_factor(camera_m, lens)).max_element();
    if camera_m.z >= NEAR_M && beside <= 0.0 { to_units(camera_m, lens) } else { FAR }
}

/// Half the widened picture in (u, v).
fn guard(lens: &Lens) -> Vec2 {
    0.5 * lens.size() * lens.pixel * GUARD
}

/// What (u, v) are multiplied by at a point.
fn depth_factor(camera_m: Vec3, lens: &Lens) -> f32 {
    if lens.is_perspective { camera_m.z } else { 1.0 }
}

fn to_units(camera_m: Vec3, lens: &Lens) -> [i32; 2] {
    let px = camera_m.truncate() / (depth_factor(camera_m, lens) * lens.pixel) + 0.5 * lens.size();
    (px * UNITS as f32).to_array().map(round)
}

/// The nearest integer, halves away from zero; without a call of the system's library.
fn round(value: f32) -> i32 {
    let whole = value as i32;
    let rest = value - whole as f32;
    whole.saturating_add(i32::from(rest >= 0.5) - i32::from(rest <= -0.5))
}

impl Projection<'_> {
    /// Appends the parts of a triangle that may hold a sample, of its corners' positions in the picture and in the world.
    /// `hides_back` leaves out a triangle that shows its back.
    pub(crate) fn append_visible(
        &self,
        out: &mut Vec<ScreenTriangle>,
        index: u32,
        corners: [[i32; 2]; 3],
        corners_m: impl Fn() -> [Vec3; 3],
        hides_back: bool,
    ) {
        let lens = self.lens;
        let in_camera_m = || corners_m().map(|corner_m| lens.to_camera(corner_m));
        if !corners.contains(&FAR) {
            out.extend(self.triangle(index, corners, in_camera_m, hides_back));
            return;
        }
        let half = guard(lens);
        let mut polygon = Polygon { corners: [Vec3::ZERO; CORNERS_MAX], count: 3 };
        polygon.corners[..3].copy_from_slice(&in_camera_m());
        polygon.clip(|corner| corner.z - NEAR_M);
        for axis in [0, 1] {
            for sign in [-1.0, 1.0] {
                polygon.clip(|corner| half[axis] * depth_factor(corner, lens) - sign * corner[axis]);
            }
        }
        for last in 2..polygon.count {
            let part = [polygon.corners[0], polygon.corners[last - 1], polygon.corners[last]];
            out.extend(self.triangle(index, part.map(|corner| to_units(corner, lens)), in_camera_m, hides_back));
        }
    }

    /// A part of a triangle; depths are those of the whole triangle's plane. None without area or sample.
    fn triangle(
        &self,
        index: u32,
        mut corners: [[i32; 2]; 3],
        corners_m: impl Fn() -> [Vec3; 3],
        hides_back: bool,
    ) -> Option<ScreenTriangle> {
        let edge = |from: [i32; 2], to: [i32; 2]| [i64::from(to[0] - from[0]), i64::from(to[1] - from[1])];
        let (first, second) = (edge(corners[0], corners[1]), edge(corners[0], corners[2]));
        let area = first[0] * second[1] - first[1] * second[0];
        // Corners are counter-clockwise seen from outside, and y points down.
        if area == 0 || (hides_back && area > 0) || !self.may_hold_sample(corners) {
            return None;
        }
        if area < 0 {
            corners.swap(1, 2);
        }
        // The plane n·x = k, with x = depth·(u, v, 1) or (u, v, depth).
        let corners_m = corners_m();
        let normal = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]);
        let level = normal.dot(corners_m[0]);
        let depth =
            if self.lens.is_perspective { normal / level } else { Vec3::new(-normal.x, -normal.y, level) / normal.z };
        depth.is_finite().then_some(ScreenTriangle { index, corners, depth })
    }

    /// Whether a sample of the lines lies in the box around three corners: most triangles of a distant body hold none.
    fn may_hold_sample(&self, corners: [[i32; 2]; 3]) -> bool {
        let ranges = [range(&corners, 0), range(&corners, 1)];
        let is_beside = |[low, high]: [i32; 2], [first, end]: [i32; 2]| high < first * UNITS || low >= end * UNITS;
        if is_beside(ranges[0], [0, self.lens.size_px[0] as i32]) || is_beside(ranges[1], self.lines) {
            return false;
        }
        // The first sample that is not before the box is not behind it.
        let holds = |[low, high]: [i32; 2], offset: i32| {
            (low - offset - 1).div_euclid(UNITS) < (high - offset).div_euclid(UNITS)
        };
        let is_large = ranges.iter().all(|[low, high]| high - low >= UNITS);
        let mut offsets = self.pattern.offsets().iter();
        is_large || offsets.any(|offset| holds(ranges[0], offset[0]) && holds(ranges[1], offset[1]))
    }
}

/// Least and greatest position of three corners along an axis, units.
#[inline]
fn range([a, b, c]: &[[i32; 2]; 3], axis: usize) -> [i32; 2] {
    [a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis])]
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
    /// First and last pixel (inclusive) of columns and rows, within the picture.
    #[inline]
    pub(crate) fn bounds(&self, size_px: [u32; 2]) -> PixelBounds {
        let pixel = |units: i32, axis: usize| units.div_euclid(UNITS).clamp(0, size_px[axis] as i32 - 1) as u32;
        let ([left, right], [top, bottom]) = (range(&self.corners, 0), range(&self.corners, 1));
        [[pixel(left, 0), pixel(top, 1)], [pixel(right, 0), pixel(bottom, 1)]]
    }

    /// Whether `i32` holds its edge functions at all pixels that it touches.
    pub(crate) fn is_small(&self) -> bool {
        (0..2).all(|axis| {
            let [low, high] = range(&self.corners, axis);
            high - low <= SMALL_UNITS
        })
    }

    /// The three edge functions.
    pub(crate) fn edges(&self) -> [Edge; 3] {
        [0, 1, 2].map(|index| {
            let (from, to) = (self.corners[index], self.corners[(index + 1) % 3]);
            Edge { origin: from, step: [from[1] - to[1], to[0] - from[0]] }
        })
    }

    /// Depth at (u, v), m.
    #[inline]
    pub(crate) fn depth_m(&self, uv: Vec2, is_perspective: bool) -> f32 {
        let linear = self.depth.x * uv.x + self.depth.y * uv.y + self.depth.z;
        if is_perspective { 1.0 / linear } else { linear }
    }
}

/// Integers in which edge functions are exact: `i32` for triangles up to [`SMALL_UNITS`], else `i64`.
pub(crate) trait EdgeValue:
    Copy + From<i32> + Add<Output = Self> + Mul<Output = Self> + BitOr<Output = Self> + PartialOrd
{
}

impl EdgeValue for i32 {}
impl EdgeValue for i64 {}

impl Edge {
    /// Change over some units along x and y.
    pub(crate) fn step<T: EdgeValue>(&self, units: [i32; 2]) -> T {
        T::from(units[0]) * T::from(self.step[0]) + T::from(units[1]) * T::from(self.step[1])
    }

    /// Value at a position in units.
    pub(crate) fn at<T: EdgeValue>(&self, position: [i32; 2]) -> T {
        self.step([position[0] - self.origin[0], position[1] - self.origin[1]])
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

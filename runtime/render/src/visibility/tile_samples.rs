//! One tile of the picture: nearest depth and part at each sample, and their sum for a pixel.

use glam::{Vec2, Vec3};

use crate::visibility::lens::{GroundDepth, Lens};
use crate::visibility::part::PartId;
use crate::visibility::rounded_cone::PreparedCone;
use crate::visibility::sample_pattern::{SampleOffsets, SamplePattern, UNITS};
use crate::visibility::triangle::{EdgeValue, ScreenTriangle};

/// What one part contributes to one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragment {
    /// The part.
    pub part: PartId,
    /// Number of the pixel's samples at which it lies nearest.
    pub samples: u32,
    /// Least depth of these samples, m; infinite for the sky.
    pub depth_m: f32,
    /// Mean of the points at these samples, camera space, m; for the sky, the mean ray's (u, v, 1).
    pub point_m: Vec3,
}

/// Depth and part of every sample of a tile.
#[derive(Clone, Debug)]
pub struct TileSamples<'a> {
    /// The lens.
    pub lens: &'a Lens,
    /// Samples of a pixel.
    pub pattern: SamplePattern,
    /// First column and row, pixels.
    pub corner_px: [u32; 2],
    /// Number of columns and rows.
    pub size_px: [u32; 2],
    /// Whether any cone or triangle can touch the tile.
    pub has_parts: bool,
    /// Depth of each sample, pixel by pixel, m; infinite where there is only the sky.
    pub depths_m: Vec<f32>,
    /// Part of each sample, pixel by pixel.
    pub parts: Vec<PartId>,
}

/// Adds a step to each edge function at all samples.
#[inline]
fn advance<T: EdgeValue, const N: usize>(values: &mut [[T; N]; 3], steps: [T; 3]) {
    for (values, step) in values.iter_mut().zip(steps) {
        values.iter_mut().for_each(|value| *value = *value + step);
    }
}

impl<'a> TileSamples<'a> {
    /// A tile that shows only the sky.
    pub(crate) fn new(lens: &'a Lens, pattern: SamplePattern, corner_px: [u32; 2], side_px: u32) -> Self {
        let size_px = [0, 1].map(|axis| side_px.min(lens.size_px[axis] - corner_px[axis]));
        let count = (size_px[0] * size_px[1]) as usize * pattern.count();
        let (depths_m, parts) = (vec![f32::INFINITY; count], vec![PartId::SKY; count]);
        Self { lens, pattern, corner_px, size_px, has_parts: false, depths_m, parts }
    }

    /// (u, v) of the samples of the pixel in the upper left corner.
    fn first_uvs(&self) -> impl Iterator<Item = Vec2> + use<> {
        let (lens, corner_px) = (*self.lens, Vec2::new(self.corner_px[0] as f32, self.corner_px[1] as f32));
        let to_px = |[x, y]: [i32; 2]| Vec2::new(x as f32, y as f32) / UNITS as f32;
        self.pattern.offsets().iter().map(move |offset| lens.to_uv(corner_px + to_px(*offset)))
    }

    /// (u, v) of a sample, by its index in the tile.
    pub fn uv(&self, sample: usize) -> Vec2 {
        let offset = self.pattern.offsets()[sample % self.pattern.count()];
        let within = Vec2::new(offset[0] as f32, offset[1] as f32) * (self.lens.pixel / UNITS as f32);
        self.pixel_uv(sample / self.pattern.count()) + within
    }

    /// (u, v) of the upper left corner of a pixel, by its index in the tile.
    fn pixel_uv(&self, pixel: usize) -> Vec2 {
        let pixel = pixel as u32;
        let corner = [self.corner_px[0] + pixel % self.size_px[0], self.corner_px[1] + pixel / self.size_px[0]];
        self.lens.to_uv(Vec2::new(corner[0] as f32, corner[1] as f32))
    }

    /// Draws the ground behind everything.
    pub(crate) fn put_ground(&mut self, ground: &GroundDepth) {
        let (count, width, pixel) = (self.pattern.count(), self.size_px[0], self.lens.pixel);
        for (sample, first_uv) in self.first_uvs().enumerate() {
            for row in 0..self.size_px[1] {
                let v = first_uv.y + row as f32 * pixel;
                for column in 0..width {
                    let depth_m = ground.depth_m(Vec2::new(first_uv.x + column as f32 * pixel, v));
                    let at = (row * width + column) as usize * count + sample;
                    self.depths_m[at] = depth_m;
                    self.parts[at] = if depth_m < f32::INFINITY { PartId::GROUND } else { PartId::SKY };
                }
            }
        }
    }

    /// Columns and rows, in the tile, that lie within bounds of the picture.
    fn window(&self, [first, last]: [[u32; 2]; 2]) -> [std::ops::Range<u32>; 2] {
        [0, 1].map(|axis| {
            let low = first[axis].max(self.corner_px[axis]) - self.corner_px[axis];
            let end = (last[axis] + 1).min(self.corner_px[axis] + self.size_px[axis]);
            low..end.saturating_sub(self.corner_px[axis])
        })
    }

    /// Draws a cone where it is nearest.
    pub(crate) fn draw_cone(&mut self, cone: &PreparedCone, part: PartId, bounds: [[u32; 2]; 2]) {
        self.has_parts = true;
        match self.lens.is_perspective {
            true => self.draw_cone_along::<true>(cone, part, bounds),
            false => self.draw_cone_along::<false>(cone, part, bounds),
        }
    }

    fn draw_cone_along<const IS_PERSPECTIVE: bool>(
        &mut self,
        cone: &PreparedCone,
        part: PartId,
        bounds: [[u32; 2]; 2],
    ) {
        let [columns, rows] = self.window(bounds);
        let count = self.pattern.count();
        let width = self.size_px[0];
        let pixel = self.lens.pixel;
        for (sample, first_uv) in self.first_uvs().enumerate() {
            for row in rows.clone() {
                let v = first_uv.y + row as f32 * pixel;
                for column in columns.clone() {
                    let uv = Vec2::new(first_uv.x + column as f32 * pixel, v);
                    if let Some(depth_m) = cone.depth_along_m::<IS_PERSPECTIVE>(uv) {
                        let at = (row * width + column) as usize * count + sample;
                        self.put(at, depth_m, part);
                    }
                }
            }
        }
    }

    /// Draws a triangle where it is nearest, and where `is_solid` holds of (u, v), depth and sample.
    pub(crate) fn draw_triangle(
        &mut self,
        triangle: &ScreenTriangle,
        part: PartId,
        bounds: [[u32; 2]; 2],
        is_solid: impl Fn(Vec2, f32, usize) -> bool,
    ) {
        self.has_parts = true;
        match (self.pattern, triangle.is_small()) {
            (SamplePattern::One, true) => self.draw_triangle_in::<i32, 1>(triangle, part, bounds, is_solid),
            (SamplePattern::One, false) => self.draw_triangle_in::<i64, 1>(triangle, part, bounds, is_solid),
            (SamplePattern::Four, true) => self.draw_triangle_in::<i32, 4>(triangle, part, bounds, is_solid),
            (SamplePattern::Four, false) => self.draw_triangle_in::<i64, 4>(triangle, part, bounds, is_solid),
            (SamplePattern::Sixteen, true) => self.draw_triangle_in::<i32, 16>(triangle, part, bounds, is_solid),
            (SamplePattern::Sixteen, false) => self.draw_triangle_in::<i64, 16>(triangle, part, bounds, is_solid),
        }
    }

    /// As [`Self::draw_triangle`], with edge functions in `T`, at all `N` samples of a pixel together.
    fn draw_triangle_in<T: EdgeValue, const N: usize>(
        &mut self,
        triangle: &ScreenTriangle,
        part: PartId,
        bounds: [[u32; 2]; 2],
        is_solid: impl Fn(Vec2, f32, usize) -> bool,
    ) {
        let [columns, rows] = self.window(bounds);
        let width = self.size_px[0];
        let offsets = SampleOffsets::<N>::UNITS;
        let pixel = self.lens.pixel;
        let first_uv = self.lens.to_uv(Vec2::new(self.corner_px[0] as f32, self.corner_px[1] as f32));
        let share = |offset: i32| offset as f32 / UNITS as f32;
        let edges = triangle.edges();
        let first = [self.corner_px[0] + columns.start, self.corner_px[1] + rows.start].map(|px| px as i32 * UNITS);
        let mut of_row: [[T; N]; 3] = edges.map(|edge| offsets.map(|[x, y]| edge.at([first[0] + x, first[1] + y])));
        let steps: [[T; 3]; 2] = [[UNITS, 0], [0, UNITS]].map(|units| edges.map(|edge| edge.step(units)));
        for row in rows {
            let mut values = of_row;
            for column in columns.clone() {
                // No value is negative.
                let is_inside: [bool; N] = std::array::from_fn(|sample| {
                    values[0][sample] | values[1][sample] | values[2][sample] >= T::from(0)
                });
                if is_inside.contains(&true) {
                    let first_sample = (row * width + column) as usize * N;
                    for sample in (0..N).filter(|sample| is_inside[*sample]) {
                        let [x, y] = offsets[sample].map(share);
                        let uv = first_uv + Vec2::new(column as f32 + x, row as f32 + y) * pixel;
                        let depth_m = triangle.depth_m(uv, self.lens.is_perspective);
                        if is_solid(uv, depth_m, sample) {
                            self.put(first_sample + sample, depth_m, part);
                        }
                    }
                }
                advance(&mut values, steps[0]);
            }
            advance(&mut of_row, steps[1]);
        }
    }

    #[inline]
    fn put(&mut self, at: usize, depth_m: f32, part: PartId) {
        if depth_m < self.depths_m[at] && depth_m > 0.0 {
            self.depths_m[at] = depth_m;
            self.parts[at] = part;
        }
    }

    /// The fragment of a pixel that shows one part.
    fn whole_pixel(&self, pixel: usize, first_uv: Vec2) -> Fragment {
        let count = self.pattern.count();
        let part = self.parts[pixel * count];
        let depths_m = &self.depths_m[pixel * count..(pixel + 1) * count];
        let (mut sum_m, mut least_m) = (Vec3::ZERO, f32::INFINITY);
        for (offset, depth_m) in self.pattern.offsets().iter().zip(depths_m) {
            let uv = first_uv + Vec2::new(offset[0] as f32, offset[1] as f32) * (self.lens.pixel / UNITS as f32);
            least_m = least_m.min(*depth_m);
            sum_m += if part == PartId::SKY { uv.extend(1.0) } else { self.lens.at_depth(uv, *depth_m) };
        }
        Fragment { part, samples: count as u32, depth_m: least_m, point_m: sum_m / count as f32 }
    }

    /// The parts of a pixel of the tile, in the order of their first samples.
    pub fn fragments(&self, pixel: usize, fragments: &mut Vec<Fragment>) {
        fragments.clear();
        let count = self.pattern.count();
        let first_uv = self.pixel_uv(pixel);
        let parts = &self.parts[pixel * count..(pixel + 1) * count];
        if parts.iter().all(|part| *part == parts[0]) {
            fragments.push(self.whole_pixel(pixel, first_uv));
            return;
        }
        for (index, offset) in self.pattern.offsets().iter().enumerate() {
            let sample = pixel * count + index;
            let (part, depth_m) = (self.parts[sample], self.depths_m[sample]);
            let uv = first_uv + Vec2::new(offset[0] as f32, offset[1] as f32) * (self.lens.pixel / UNITS as f32);
            let point_m = if part == PartId::SKY { uv.extend(1.0) } else { self.lens.at_depth(uv, depth_m) };
            match fragments.iter_mut().find(|fragment| fragment.part == part) {
                Some(fragment) => {
                    fragment.samples += 1;
                    fragment.depth_m = fragment.depth_m.min(depth_m);
                    fragment.point_m += point_m;
                }
                None => fragments.push(Fragment { part, samples: 1, depth_m, point_m }),
            }
        }
        for fragment in fragments {
            fragment.point_m /= fragment.samples as f32;
        }
    }
}

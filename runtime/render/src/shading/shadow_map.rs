//! Shadows of the sun: depths from the sun's side, and a filtered look-up. World, metres.
//!
//! The map is drawn by the same visibility as the picture, with an orthographic lens and one sample a pixel.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::shading::light::TO_SUN;
use crate::visibility::{Lens, SamplePattern, SceneParts, TILE_PX, for_each_tile};

/// Greatest side of the map, pixels; sides are whole tiles.
const MAX_SIDE_PX: u32 = 4096;
/// Least length of a texel, m.
const MIN_TEXEL_M: f32 = 0.008;
/// Distance of the map's eye from the middle of what casts shadow, m.
const EYE_DISTANCE_M: f32 = 600.0;
/// Distance by which a point is lifted off its surface, m, and in texels.
const LIFT_M: f32 = 0.012;
/// As [`LIFT_M`], in texels.
const LIFT_TEXELS: f32 = 1.2;
/// Width of the soft edge of a shadow per metre from what casts it, m: the sun's disc seems 0.5° wide, and the air
/// scatters some more.
const SOFTNESS: f32 = 0.022;
/// Least and greatest half width of the filter, texels.
const FILTER_TEXELS: [f32; 2] = [1.0, 5.0];
/// Side of a block of texels, pixels: more than the filter reaches.
const BLOCK_PX: u32 = 8;
/// Taps along each side of a narrow and of a wide filter.
const TAPS: [i32; 2] = [2, 4];
/// Half width from which a filter is wide, texels.
const WIDE_TEXELS: f32 = 1.6;

/// Depths as the sun sees them.
#[derive(Clone, Debug)]
pub(crate) struct ShadowMap {
    lens: Lens,
    /// Depths of each tile; none where it holds nothing.
    tiles: Vec<Vec<f32>>,
    columns: u32,
    /// Least depth in and around each block.
    blocks: Vec<f32>,
}

impl ShadowMap {
    /// The map of all cones and of the triangles near them; none where nothing casts shadow. `extra_m` are further
    /// points that the map holds.
    pub(crate) fn new(scene: &SceneParts, extra_m: &[Vec3]) -> Option<Self> {
        let flat = Lens::orthographic([1, 1], Vec3::ZERO, -TO_SUN, 1.0);
        let cones = scene.cones.iter().chain(&scene.occluders).flat_map(|cone| cone.ends_m);
        // The top of a body throws its shadow on the ground beside its feet.
        let points =
            cones.chain(extra_m.iter().copied()).flat_map(|point| [point, point - TO_SUN * (point.z / TO_SUN.z)]);
        let corners = points.map(|point| flat.to_camera(point).truncate());
        let [low, high] = corners.map(|at| [at; 2]).reduce(|[low, high], [at, _]| [low.min(at), high.max(at)])?;
        let extent_m = high - low + 0.8;
        let texel_m = (extent_m.max_element() / MAX_SIDE_PX as f32).max(MIN_TEXEL_M);
        let size_px =
            (extent_m / texel_m).to_array().map(|side| (side as u32 + 1).next_multiple_of(TILE_PX).min(MAX_SIDE_PX));
        let middle = 0.5 * (low + high);
        let eye_m = flat.to_world(middle.extend(0.0)) + TO_SUN * EYE_DISTANCE_M;
        let lens = Lens::orthographic(size_px, eye_m, -TO_SUN, texel_m * size_px[0] as f32);
        let columns = size_px[0].div_ceil(TILE_PX);
        let tiles = for_each_tile(scene, &lens, SamplePattern::One, None, |tile| {
            if tile.has_parts { std::mem::take(&mut tile.depths_m) } else { Vec::new() }
        });
        let mut map = Self { lens, tiles, columns, blocks: Vec::new() };
        map.blocks = map.nearest_of_blocks();
        Some(map)
    }

    /// For each block of texels, the least depth in it and in the blocks around.
    fn nearest_of_blocks(&self) -> Vec<f32> {
        let [columns, rows] = self.lens.size_px.map(|side| side.div_ceil(BLOCK_PX) as usize);
        let mut least_m = vec![f32::INFINITY; columns * rows];
        for (index, tile) in self.tiles.iter().enumerate() {
            let [left, top] = [index as u32 % self.columns * TILE_PX, index as u32 / self.columns * TILE_PX];
            for (row, line) in tile.chunks(TILE_PX as usize).enumerate() {
                let first = (top as usize + row) / BLOCK_PX as usize * columns + (left / BLOCK_PX) as usize;
                for (block, texels) in line.chunks(BLOCK_PX as usize).enumerate() {
                    let nearest_m = texels.iter().copied().fold(f32::INFINITY, f32::min);
                    least_m[first + block] = least_m[first + block].min(nearest_m);
                }
            }
        }
        let around = |block: usize| {
            let near = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
            let rows = near(block / columns, rows);
            let blocks = rows.flat_map(|row| near(block % columns, columns).map(move |column| row * columns + column));
            blocks.map(|block| least_m[block]).fold(f32::INFINITY, f32::min)
        };
        (0..least_m.len()).into_par_iter().map(around).collect()
    }

    #[inline]
    fn depth_m(&self, x: i32, y: i32) -> f32 {
        // Negative coordinates become great ones.
        let (x, y) = (x as u32, y as u32);
        if x >= self.lens.size_px[0] || y >= self.lens.size_px[1] {
            return f32::INFINITY;
        }
        let tile = &self.tiles[(y / TILE_PX * self.columns + x / TILE_PX) as usize];
        tile.get((y % TILE_PX * TILE_PX + x % TILE_PX) as usize).copied().unwrap_or(f32::INFINITY)
    }

    /// Share of the sun's light that reaches a point of a surface with this normal.
    pub(crate) fn light_at(&self, point_m: Vec3, normal: Vec3) -> f32 {
        let texel_m = self.lens.pixel;
        let lifted_m = point_m + normal * (LIFT_M + LIFT_TEXELS * texel_m);
        let at = self.lens.to_camera(lifted_m);
        let px = at.truncate() / texel_m + 0.5 * self.lens.size();
        let [x, y] = px.to_array().map(floor);
        let [width, height] = self.lens.size_px.map(|side| side as i32);
        if x < 0 || y < 0 || x >= width || y >= height {
            return 1.0;
        }
        let block = (y as u32 / BLOCK_PX * self.lens.size_px[0].div_ceil(BLOCK_PX) + x as u32 / BLOCK_PX) as usize;
        if self.blocks[block] >= at.z {
            return 1.0;
        }
        // How far away the blockers lie decides the softness.
        let (mut blocked, mut gap_m) = (0, 0.0);
        for (shift_x, shift_y) in [(0, 0), (-3, -2), (3, -3), (2, 3), (-3, 3), (0, -5), (0, 5), (-5, 0), (5, 0)] {
            let depth_m = self.depth_m(x + shift_x, y + shift_y);
            if depth_m < at.z {
                blocked += 1;
                gap_m += at.z - depth_m;
            }
        }
        if blocked == 0 {
            return 1.0;
        }
        let half = (0.5 * SOFTNESS * gap_m / blocked as f32 / texel_m).clamp(FILTER_TEXELS[0], FILTER_TEXELS[1]);
        self.filtered(px, at.z, half)
    }

    /// Share of lit texels, bilinear at each tap, over a square with half this side, texels.
    fn filtered(&self, px: Vec2, depth_m: f32, half: f32) -> f32 {
        let taps = TAPS[usize::from(half >= WIDE_TEXELS)];
        let spacing = 2.0 * half / taps as f32;
        let mut sum = 0.0;
        for row in 0..taps {
            for column in 0..taps {
                let shift = Vec2::new(column as f32, row as f32) - 0.5 * (taps - 1) as f32;
                sum += self.bilinear(px + spacing * shift, depth_m);
            }
        }
        sum / (taps * taps) as f32
    }

    fn bilinear(&self, px: Vec2, depth_m: f32) -> f32 {
        let [x, y] = (px - 0.5).to_array().map(floor);
        let share = px - 0.5 - Vec2::new(x as f32, y as f32);
        let lit = |shift_x: i32, shift_y: i32| f32::from(self.depth_m(x + shift_x, y + shift_y) >= depth_m);
        let above = lit(0, 0) + share.x * (lit(1, 0) - lit(0, 0));
        let below = lit(0, 1) + share.x * (lit(1, 1) - lit(0, 1));
        above + share.y * (below - above)
    }
}

/// Greatest integer that is at most a number; without a call of the system's library.
#[inline]
fn floor(value: f32) -> i32 {
    let whole = value as i32;
    whole - i32::from(whole as f32 > value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{Cone, Owner};

    #[test]
    fn a_ball_shades_what_lies_behind_it_from_the_sun() {
        let centre = Vec3::new(3.0, 2.0, 1.5);
        let cone = Cone { ends_m: [centre; 2], radii_m: [0.3; 2], colour: Vec3::ONE, owner: Owner::SCENE };
        let scene = SceneParts { cones: vec![cone], ..SceneParts::default() };
        let map = ShadowMap::new(&scene, &[]).unwrap();
        let on_ground = |beside: Vec3| {
            let point = centre + beside;
            map.light_at(point - TO_SUN * (point.z / TO_SUN.z), Vec3::Z)
        };
        assert_eq!(on_ground(Vec3::ZERO), 0.0);
        assert_eq!(on_ground(Vec3::new(0.6, 0.0, 0.0)), 1.0);
        // The side towards the sun is lit.
        assert_eq!(map.light_at(centre + 0.3 * TO_SUN, TO_SUN), 1.0);
        let edge = (0..40).map(|step| on_ground(Vec3::new(0.0, 0.01 * step as f32, 0.0))).collect::<Vec<_>>();
        assert!(edge.iter().any(|light| (0.2..0.8).contains(light)), "{edge:?}");
    }
}

//! Shadows of the sun: depths from the sun's side, and a filtered look-up. World, metres.
//!
//! The map is drawn by the same visibility as the picture, with an orthographic lens and one sample a pixel.

use glam::{Vec2, Vec3};

use crate::shading::light::TO_SUN;
use crate::visibility::{Lens, SamplePattern, SceneParts, TILE_PX, for_each_tile};

/// Greatest side of the map, pixels.
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
/// Taps along each side of the filter.
const TAPS: i32 = 4;

/// Depths as the sun sees them.
#[derive(Clone, Debug)]
pub(crate) struct ShadowMap {
    lens: Lens,
    tiles: Vec<Vec<f32>>,
    columns: u32,
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
        let size_px = (extent_m / texel_m).to_array().map(|side| (side as u32 + 1).clamp(1, MAX_SIDE_PX));
        let middle = 0.5 * (low + high);
        let eye_m = flat.to_world(middle.extend(0.0)) + TO_SUN * EYE_DISTANCE_M;
        let lens = Lens::orthographic(size_px, eye_m, -TO_SUN, texel_m * size_px[0] as f32);
        let columns = size_px[0].div_ceil(TILE_PX);
        let tiles = for_each_tile(scene, &lens, SamplePattern::One, None, |tile| std::mem::take(&mut tile.depths_m));
        Some(Self { lens, tiles, columns })
    }

    fn depth_m(&self, x: i32, y: i32) -> f32 {
        let [width, height] = self.lens.size_px.map(|side| side as i32);
        if x < 0 || y < 0 || x >= width || y >= height {
            return f32::INFINITY;
        }
        let (x, y) = (x as u32, y as u32);
        let (column, row) = (x / TILE_PX, y / TILE_PX);
        let tile_width = TILE_PX.min(self.lens.size_px[0] - column * TILE_PX);
        self.tiles[(row * self.columns + column) as usize][(y % TILE_PX * tile_width + x % TILE_PX) as usize]
    }

    /// Share of the sun's light that reaches a point of a surface with this normal.
    pub(crate) fn light_at(&self, point_m: Vec3, normal: Vec3) -> f32 {
        let texel_m = self.lens.pixel;
        let lifted_m = point_m + normal * (LIFT_M + LIFT_TEXELS * texel_m);
        let at = self.lens.to_camera(lifted_m);
        let px = at.truncate() / texel_m + 0.5 * self.lens.size();
        let texel = px.floor();
        let [x, y] = texel.to_array().map(|side| side as i32);
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
        let spacing = 2.0 * half / TAPS as f32;
        let mut sum = 0.0;
        for row in 0..TAPS {
            for column in 0..TAPS {
                let shift = Vec2::new(column as f32, row as f32) - 0.5 * (TAPS - 1) as f32;
                sum += self.bilinear(px + spacing * shift, depth_m);
            }
        }
        sum / (TAPS * TAPS) as f32
    }

    fn bilinear(&self, px: Vec2, depth_m: f32) -> f32 {
        let corner = (px - 0.5).floor();
        let share = px - 0.5 - corner;
        let [x, y] = corner.to_array().map(|side| side as i32);
        let lit = |shift_x: i32, shift_y: i32| f32::from(self.depth_m(x + shift_x, y + shift_y) >= depth_m);
        let above = lit(0, 0) + share.x * (lit(1, 0) - lit(0, 0));
        let below = lit(0, 1) + share.x * (lit(1, 1) - lit(0, 1));
        above + share.y * (below - above)
    }
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

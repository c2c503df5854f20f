//! Shade on the ground: what stands between sun and ground, collected in a mask and laid over the picture once.
//!
//! A mask takes the greatest of overlapping shades, so that two limbs over one spot do not darken it twice. The sun
//! stands at the upper left and high: shade falls to the lower right and is short enough that a crowd stays readable.

use glam::{Vec2, Vec3};
use tiny_skia::{FillRule, Mask, Path, Pixmap, Transform};

use crate::raster::body::Part;
use crate::raster::palette::SHADE;
use crate::raster::tapered_capsule::{self, Cone};
use crate::top_view::framing::Framing;

/// Where the shade of a point falls, for each metre of its height: to the right and down, m. A sun 68° high.
const SUN_SLOPE: Vec2 = Vec2::new(0.26, 0.31);
/// How much of the light the shade takes.
const DARKNESS: f32 = 0.30;
/// Width of a shade's soft edge at the ground, and its growth for each metre of height, m.
const SOFTNESS_M: [f32; 2] = [0.03, 0.07];
/// Least softness, the anti-aliasing of small shapes, pixels.
const MIN_SOFTNESS_PX: f32 = 0.75;

/// Shade by pixel, 0 to 255.
#[derive(Clone, Debug)]
pub struct ShadeMask {
    size_px: [u32; 2],
    depths: Vec<u8>,
}

impl ShadeMask {
    /// Without any shade.
    pub fn new(framing: &Framing) -> Self {
        let size_px = [framing.width_px, framing.height_px];
        Self { size_px, depths: vec![0; framing.width_px as usize * framing.height_px as usize] }
    }

    /// Takes all shade away.
    pub fn clear(&mut self) {
        self.depths.fill(0);
    }

    /// Adds the shade of one part of a body.
    pub fn add_part(&mut self, framing: &Framing, part: &Part) {
        let scale = framing.scale_px_m;
        let on_ground = |end: Vec3| (framing.to_px(end.truncate()) + SUN_SLOPE * end.z.max(0.0) * scale).extend(0.0);
        let height_m = 0.5 * (part.ends_m[0].z + part.ends_m[1].z);
        let softness_px = (scale * (SOFTNESS_M[0] + SOFTNESS_M[1] * height_m.max(0.0))).max(MIN_SOFTNESS_PX);
        let cone = Cone { ends_px: part.ends_m.map(on_ground), radii_px: part.radii_m.map(|radius| radius * scale) };
        tapered_capsule::shade(&mut self.depths, self.size_px, &cone, softness_px);
    }

    /// Adds the shade of a block with the given outline in pixels, as high as the sweep along the sun's slope is long.
    pub fn add_block(&mut self, framing: &Framing, outline: &Path, height_m: f32) {
        let Some(mut mask) = Mask::new(self.size_px[0], self.size_px[1]) else { return };
        let sweep_px = SUN_SLOPE * height_m * framing.scale_px_m;
        // One copy a pixel of the sweep leaves no steps.
        let copies = (sweep_px.length() as usize).clamp(1, 256);
        for copy in 0..=copies {
            let shift = sweep_px * (copy as f32 / copies as f32);
            mask.fill_path(outline, FillRule::Winding, true, Transform::from_translate(shift.x, shift.y));
        }
        for (depth, covered) in self.depths.iter_mut().zip(mask.data()) {
            *depth = (*depth).max(*covered);
        }
    }

    /// Softens all shade so far: two box blurs in each direction.
    pub fn blur(&mut self, radius_px: f32) {
        let radius = (radius_px as usize).clamp(1, 64);
        let [width, height] = self.size_px.map(|side| side as usize);
        for _ in 0..2 {
            for y in 0..height {
                box_blur(&mut self.depths, y * width, 1, width, radius);
            }
            for x in 0..width {
                box_blur(&mut self.depths, x, width, height, radius);
            }
        }
    }

    /// Lays the shade over an opaque picture.
    pub fn apply(&self, pixmap: &mut Pixmap) {
        for (pixel, depth) in tapered_capsule::pixels_mut(pixmap).iter_mut().zip(&self.depths) {
            if *depth > 0 {
                let share = DARKNESS * f32::from(*depth) / 255.0;
                *pixel = tapered_capsule::to_pixel(tapered_capsule::to_vec(*pixel).lerp(SHADE, share));
            }
        }
    }
}

/// The mean over 2·radius + 1 neighbours of `count` values, `stride` apart, from `start`; beyond the ends lies no
/// shade.
fn box_blur(values: &mut [u8], start: usize, stride: usize, count: usize, radius: usize) {
    let line: Vec<u8> = (0..count).map(|index| values[start + index * stride]).collect();
    let window = 2 * radius as u32 + 1;
    let mut sum: u32 = line.iter().take(radius).map(|value| u32::from(*value)).sum();
    for index in 0..count {
        sum += line.get(index + radius).map_or(0, |value| u32::from(*value));
        values[start + index * stride] = ((sum + window / 2) / window) as u8;
        sum -= index.checked_sub(radius).map_or(0, |leaving| u32::from(line[leaving]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_blur_is_the_mean_of_the_neighbours() {
        let line: Vec<u8> = (0..40).map(|index: u32| (index * 7919 % 256) as u8).collect();
        for radius in [1, 3, 50] {
            let mut blurred = line.clone();
            box_blur(&mut blurred, 0, 1, line.len(), radius);
            for (index, found) in blurred.iter().enumerate() {
                let window = index.saturating_sub(radius)..(index + radius + 1).min(line.len());
                let mean = line[window].iter().map(|value| f32::from(*value)).sum::<f32>() / (2 * radius + 1) as f32;
                assert!((f32::from(*found) - mean).abs() <= 0.51, "{radius} {index} {found} {mean}");
            }
        }
    }
}

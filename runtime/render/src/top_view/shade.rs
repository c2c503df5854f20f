//! Shade on the ground, collected in a mask that is laid over the picture once.
//!
//! Enters: parts of bodies and outlines of obstacles. Overlapping shades count as the greatest of them: two limbs over
//! a pixel do not darken it twice. The sun is high at the upper left: shade falls to the lower right, and is short, so
//! that a crowd stays readable.

use glam::{Vec2, Vec3};
use tiny_skia::{FillRule, Mask, Path, Pixmap, Transform};

use crate::raster::drawn_body::DrawnPart;
use crate::raster::palette::SHADE;
use crate::raster::pixels::{Strip, blend, pixels_mut};
use crate::raster::tapered_capsule;
use crate::top_view::framing::Framing;

/// Displacement of a point's shade per metre of its height, right and down, m: the sun is 68° high.
const SUN_SLOPE: Vec2 = Vec2::new(0.26, 0.31);
/// Opacity of full shade.
const DARKNESS: f32 = 0.30;
/// Width of a shade's soft edge at the ground, and its increase per metre of height, m.
const SOFTNESS_M: [f32; 2] = [0.03, 0.07];
/// Least width of the soft edge, pixels: anti-aliasing of small shapes.
const MIN_SOFTNESS_PX: f32 = 0.75;

/// Shade of each pixel of a strip, 0 to 255.
#[derive(Clone, Debug)]
pub(crate) struct ShadeMask {
    strip: Strip,
    /// Shade, row by row.
    depths: Vec<u8>,
}

impl ShadeMask {
    /// A mask without shade.
    pub(crate) fn new(strip: Strip) -> Self {
        Self { strip, depths: vec![0; strip.pixel_count()] }
    }

    /// Removes all shade; the mask is then that of the rows from `top_px` on.
    pub(crate) fn clear(&mut self, top_px: u32) {
        self.strip.top_px = top_px;
        self.depths.fill(0);
    }

    /// Adds the shade of one part of a body.
    pub(crate) fn add_part(&mut self, framing: &Framing, part: &DrawnPart) {
        let scale = framing.scale_px_m;
        let on_ground = |end: Vec3| (framing.to_px(end.truncate()) + SUN_SLOPE * end.z.max(0.0) * scale).extend(0.0);
        let height_m = 0.5 * (part.ends_m[0].z + part.ends_m[1].z);
        let softness_px = (scale * (SOFTNESS_M[0] + SOFTNESS_M[1] * height_m.max(0.0))).max(MIN_SOFTNESS_PX);
        tapered_capsule::shade(&mut self.depths, &self.strip, &part.to_capsule(on_ground, scale), softness_px);
    }

    /// Adds the shade of a block with this outline (pixels) and height: the outline, swept along the sun's slope. The
    /// mask must be that of a whole picture.
    pub(crate) fn add_block(&mut self, framing: &Framing, outline: &Path, height_m: f32) {
        let Some(mut mask) = Mask::new(self.strip.width_px, self.strip.rows) else { return };
        let sweep_px = SUN_SLOPE * height_m * framing.scale_px_m;
        // One copy per pixel of the sweep: no steps are visible.
        let copies = (sweep_px.length() as usize).clamp(1, 256);
        for copy in 0..=copies {
            let shift = sweep_px * (copy as f32 / copies as f32);
            mask.fill_path(outline, FillRule::Winding, true, Transform::from_translate(shift.x, shift.y));
        }
        for (depth, covered) in self.depths.iter_mut().zip(mask.data()) {
            *depth = (*depth).max(*covered);
        }
    }

    /// Blurs all shade of a whole picture: two box blurs in each direction.
    pub(crate) fn blur(&mut self, radius_px: f32) {
        let radius = (radius_px as usize).clamp(1, 64);
        let [width, height] = [self.strip.width_px, self.strip.rows].map(|side| side as usize);
        for _ in 0..2 {
            for y in 0..height {
                box_blur(&mut self.depths, y * width, 1, width, radius);
            }
            for x in 0..width {
                box_blur(&mut self.depths, x, width, height, radius);
            }
        }
    }

    /// Darkens an opaque picture by the shade.
    pub(crate) fn apply(&self, pixmap: &mut Pixmap) {
        for (pixel, depth) in pixels_mut(pixmap).iter_mut().zip(&self.depths) {
            if *depth > 0 {
                blend(pixel, SHADE, DARKNESS * f32::from(*depth) / 255.0);
            }
        }
    }
}

/// Replaces `count` values, `stride` apart from `start` on, by means over 2·radius + 1 neighbours; beyond the ends the
/// values are 0.
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
    fn a_box_blur_is_the_mean_of_the_neighbours() {
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

//! The kernel that draws bodies and their shadows: a ball with changing radius that is swept along a bone, seen
//! from above.
//!
//! tiny-skia fills paths with flat colours and gradients. A limb needs a rounded shade across and a soft edge, for
//! twenty limbs of a thousand bodies. So each limb is painted from its distance field (I. Quilez, "2D distance
//! functions", uneven capsule): the distance gives the coverage, the offset from the bone the surface's normal.
//! Positions in pixels, x right, y down, z towards the eye.

use std::ops::Range;

use glam::{Vec2, Vec3};
use tiny_skia::Pixmap;

use crate::raster::palette::Rgb;
use crate::raster::pixels::{Pixel, PixelWindow, Strip, pixels_mut, to_pixel, to_vec};

/// Unit vector towards the light: upper left, above the eye, so that tops are bright.
const LIGHT: Vec3 = Vec3::new(-0.424, -0.530, 0.734);
/// Brightness of a surface that faces away from the light.
const AMBIENT: f32 = 0.66;
/// Additional brightness of a surface that faces the light. Facing the eye: 0.66 + 0.46·0.734 ≈ 1.
const DIFFUSE: f32 = 0.46;
/// Darkness of the rim around a limb, at its edge.
const RIM_DARKNESS: f32 = 0.40;
/// Height of the bone above the surface below from which the rim is full, rim widths.
const RIM_DROP: f32 = 5.0;

/// A ball with changing radius that is swept from one end to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TaperedCapsule {
    /// Centre of the ball at each end, pixels; z is the height above the ground.
    pub(crate) ends_px: [Vec3; 2],
    /// Radius of the ball at each end, pixels.
    pub(crate) radii_px: [f32; 2],
}

/// A picture that is being painted, with the height of each pixel's surface.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    /// Rows of the picture, opaque.
    pub(crate) pixmap: Pixmap,
    /// Position of these rows in the picture.
    pub(crate) strip: Strip,
    /// Height of each pixel's surface above the ground, pixels.
    heights_px: Vec<f32>,
}

impl Canvas {
    /// A canvas over a background: every height is 0.
    pub(crate) fn new(pixmap: Pixmap) -> Self {
        let heights_px = vec![0.0; pixmap.pixels().len()];
        let strip = Strip::whole(pixmap.width(), pixmap.height());
        Self { pixmap, strip, heights_px }
    }

    /// Clears the canvas to the rows of a background that begin at `top_px`. The last strip of a picture may end before
    /// the canvas does.
    pub(crate) fn reset(&mut self, background: &Pixmap, top_px: u32) {
        self.strip.top_px = top_px;
        let row_bytes = 4 * self.strip.width_px as usize;
        let rows = &background.data()[top_px as usize * row_bytes..];
        let data = self.pixmap.data_mut();
        let shown = rows.len().min(data.len());
        data[..shown].copy_from_slice(&rows[..shown]);
        self.heights_px.fill(0.0);
    }

    /// Paints a shaded limb with smooth edges. Higher surfaces hide it. Within `rim_px` of its edge, clearly lower
    /// surfaces get a dark rim: an arm stands out from the trunk, but upper arm and forearm merge.
    pub(crate) fn paint(&mut self, capsule: &TaperedCapsule, colour: Rgb, rim_px: f32) {
        let field = CapsuleField::new(capsule);
        let window = window_around(capsule, 0.5 + rim_px, &self.strip);
        let pixels = pixels_mut(&mut self.pixmap);
        for y in window.rows() {
            let row = self.strip.row_start(y);
            for x in field.columns(&window, y, 0.5 + rim_px) {
                let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let distance = field.distance(centre);
                if distance < 0.5 + rim_px {
                    let (pixel, below_px) = (&mut pixels[row + x], &mut self.heights_px[row + x]);
                    paint_pixel(pixel, below_px, &field.surface(centre), distance, colour, rim_px);
                }
            }
        }
    }
}

/// Paints one pixel of a limb: hidden, rim, edge or surface.
fn paint_pixel(pixel: &mut Pixel, below_px: &mut f32, surface: &LitSurface, distance: f32, colour: Rgb, rim_px: f32) {
    let coverage = (0.5 - distance).clamp(0.0, 1.0);
    let mut mixed = to_vec(*pixel);
    if coverage < 1.0 && rim_px > 0.0 {
        let nearness = 1.0 - distance.max(0.0) / (0.5 + rim_px);
        let drop = ((surface.axis_px - *below_px) / (RIM_DROP * rim_px)).clamp(0.0, 1.0);
        mixed *= 1.0 - RIM_DARKNESS * nearness * nearness * drop;
    }
    // Where two surfaces intersect, the higher one fades in over a pixel of height: the seam is smooth.
    let visible = coverage * (0.5 + surface.top_px - *below_px).clamp(0.0, 1.0);
    mixed = mixed.lerp((colour * surface.light).min(Vec3::ONE), visible);
    if visible >= 0.5 {
        *below_px = surface.top_px;
    }
    *pixel = to_pixel(mixed);
}

/// Adds a capsule's outline to a mask of shade, as the maximum of both, with an edge of width `softness_px`.
pub(crate) fn shade(mask: &mut [u8], strip: &Strip, capsule: &TaperedCapsule, softness_px: f32) {
    let field = CapsuleField::new(capsule);
    let window = window_around(capsule, softness_px, strip);
    for y in window.rows() {
        let row = &mut mask[strip.row_start(y)..][..strip.width_px as usize];
        for x in field.columns(&window, y, softness_px) {
            let distance = field.distance(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
            let depth = (0.5 - 0.5 * distance / softness_px).clamp(0.0, 1.0);
            let smooth = depth * depth * (3.0 - 2.0 * depth);
            row[x] = row[x].max((255.0 * smooth + 0.5) as u8);
        }
    }
}

/// Distance field of a capsule, prepared for many queries. Lengths in pixels.
struct CapsuleField {
    /// Start of the axis.
    start: Vec2,
    /// Axis from start to end.
    axis: Vec2,
    inverse_length_squared: f32,
    /// Length of the axis.
    length: f32,
    /// Radius at start and end.
    radii: [f32; 2],
    /// Height above the ground at start and end.
    heights: [f32; 2],
    /// Cosine and sine of the flank's slope against the axis.
    slope: Vec2,
}

/// The visible surface of a capsule at one point.
struct LitSurface {
    /// Height of the bone, pixels.
    axis_px: f32,
    /// Height of the surface, pixels.
    top_px: f32,
    /// Brightness of the surface; 1 facing the eye.
    light: f32,
}

impl CapsuleField {
    fn new(capsule: &TaperedCapsule) -> Self {
        let [start, end] = capsule.ends_px;
        let [from, to] = capsule.radii_px;
        // If the ball at one end hides the other from above, only the larger one is visible.
        if start.truncate().distance_squared(end.truncate()) <= (from - to) * (from - to) + 1e-6 {
            let (ball, radius) = if to > from { (end, to) } else { (start, from) };
            return Self::between([ball, Vec3::new(ball.x + 1e-3, ball.y, start.z.max(end.z))], [radius; 2]);
        }
        Self::between([start, end], [from, to])
    }

    fn between([start, end]: [Vec3; 2], radii: [f32; 2]) -> Self {
        let axis = end.truncate() - start.truncate();
        let length = axis.length();
        let taper = (radii[0] - radii[1]) / length;
        Self {
            start: start.truncate(),
            axis,
            inverse_length_squared: 1.0 / (length * length),
            length,
            radii,
            heights: [start.z, end.z],
            slope: Vec2::new((1.0 - taper * taper).max(0.0).sqrt(), taper),
        }
    }

    /// Signed distance to the outline, pixels: negative inside.
    fn distance(&self, point: Vec2) -> f32 {
        let offset = point - self.start;
        let across = offset.perp_dot(self.axis).abs() * self.inverse_length_squared;
        let along = offset.dot(self.axis) * self.inverse_length_squared;
        let on_flank = self.slope.x * along - self.slope.y * across;
        if on_flank < 0.0 {
            self.length * (across * across + along * along).sqrt() - self.radii[0]
        } else if on_flank > self.slope.x {
            let beyond = along - 1.0;
            self.length * (across * across + beyond * beyond).sqrt() - self.radii[1]
        } else {
            self.length * (self.slope.x * across + self.slope.y * along) - self.radii[0]
        }
    }

    /// Columns of a row within the greater radius and a margin of the axis's line: for a diagonal limb, a fraction of
    /// the window's columns.
    fn columns(&self, window: &PixelWindow, row: usize, margin_px: f32) -> Range<usize> {
        let columns = window.columns();
        if self.axis.y.abs() < 0.05 * self.length {
            return columns;
        }
        let middle = self.start.x + (row as f32 + 0.5 - self.start.y) * self.axis.x / self.axis.y;
        let reach = (self.radii[0].max(self.radii[1]) + margin_px) * self.length / self.axis.y.abs() + 1.0;
        // Casts saturate, as in `PixelWindow::between`.
        let (first, last) = ((middle - reach).max(0.0) as usize, (middle + reach).max(0.0) as usize);
        columns.start.max(first)..columns.end.min(last)
    }

    fn surface(&self, point: Vec2) -> LitSurface {
        let offset = point - self.start;
        let along = (offset.dot(self.axis) * self.inverse_length_squared).clamp(0.0, 1.0);
        let radius = self.radii[0] + along * (self.radii[1] - self.radii[0]);
        let tilt = (offset - along * self.axis) / radius.max(1e-3);
        let steepness = tilt.length_squared();
        // In the soft edge just outside the outline, the normal is that of the outline.
        let normal =
            if steepness < 1.0 { tilt.extend((1.0 - steepness).sqrt()) } else { (tilt / steepness.sqrt()).extend(0.0) };
        let axis_px = self.heights[0] + along * (self.heights[1] - self.heights[0]);
        let light = AMBIENT + DIFFUSE * normal.dot(LIGHT).max(0.0);
        LitSurface { axis_px, top_px: axis_px + radius * normal.z, light }
    }
}

/// The pixels within a margin of a capsule.
fn window_around(capsule: &TaperedCapsule, margin_px: f32, strip: &Strip) -> PixelWindow {
    let [start, end] = capsule.ends_px.map(Vec3::truncate);
    let [from, to] = capsule.radii_px.map(|radius| Vec2::splat(radius + margin_px));
    PixelWindow::between((start - from).min(end - to), (start + from).max(end + to), strip)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance to the union of many discs along the bone: the definition.
    fn brute_force_distance(capsule: &TaperedCapsule, point: Vec2) -> f32 {
        (0..=4000)
            .map(|step| {
                let share = step as f32 / 4000.0;
                let centre = capsule.ends_px[0].lerp(capsule.ends_px[1], share).truncate();
                point.distance(centre) - (capsule.radii_px[0] + share * (capsule.radii_px[1] - capsule.radii_px[0]))
            })
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn distances_are_those_to_the_swept_discs() {
        let ends_px = [Vec3::new(10.0, 12.0, 0.0), Vec3::new(31.0, 25.0, 4.0)];
        for radii_px in [[5.0, 5.0], [7.0, 2.0], [1.0, 9.0], [40.0, 3.0], [2.0, 50.0]] {
            let capsule = TaperedCapsule { ends_px, radii_px };
            let field = CapsuleField::new(&capsule);
            for y in 0..40 {
                for x in 0..40 {
                    let point = Vec2::new(x as f32, y as f32);
                    let (found, truth) = (field.distance(point), brute_force_distance(&capsule, point));
                    // Inside, the minimum over the discs is less than the distance to the outline: only signs must
                    // agree.
                    let same = if truth > 0.0 { (found - truth).abs() < 0.02 } else { found < 0.02 };
                    assert!(same, "{radii_px:?} {point} {found} {truth}");
                }
            }
        }
    }

    #[test]
    fn capsules_outside_the_picture_touch_no_pixel() {
        let mut canvas = Canvas::new(Pixmap::new(8, 8).unwrap());
        for position in [-50.0, 90.0, f32::NAN, f32::INFINITY] {
            let capsule = TaperedCapsule { ends_px: [Vec3::splat(position); 2], radii_px: [3.0; 2] };
            canvas.paint(&capsule, Vec3::ONE, 1.0);
        }
        assert!(canvas.pixmap.data().iter().all(|byte| *byte == 0));
    }
}

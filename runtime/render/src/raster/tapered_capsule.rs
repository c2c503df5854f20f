//! The one kernel behind bodies and their shadows: a ball swept along a bone while its radius changes, seen from above.
//!
//! tiny-skia fills paths with flat colours and gradients; a limb needs a rounded shade across and a soft edge, for
//! twenty limbs of a thousand bodies. So each limb is painted from its distance field (the uneven capsule of I. Quilez,
//! "2D distance functions"): coverage from the distance, the surface's normal from the offset to the bone. All in
//! pixels, x right, y down; z towards the eye.

use std::ops::Range;

use glam::{Vec2, Vec3};
use tiny_skia::Pixmap;

use crate::raster::palette::Rgb;

/// Towards the light: from the upper left, above the eye, so that tops stay bright.
const LIGHT: Vec3 = Vec3::new(-0.424, -0.530, 0.734);
/// Light that reaches every side.
const AMBIENT: f32 = 0.66;
/// Light that a surface facing [`LIGHT`] gets on top; a surface facing the eye then has 0.66 + 0.46·0.734 ≈ 1.
const DIFFUSE: f32 = 0.46;
/// Darkness of the rim that a limb casts on what lies below, at its edge.
const RIM_DARKNESS: f32 = 0.40;
/// The rim is full where the bone lies this many rim widths above what is below.
const RIM_DROP: f32 = 5.0;

/// A swept ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centres of the ball at both ends, pixels; z is the height over the ground.
    pub ends_px: [Vec3; 2],
    /// Its radii there, pixels.
    pub radii_px: [f32; 2],
}

/// A picture in the making that knows how high above the ground each pixel's surface lies.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// Opaque.
    pub pixmap: Pixmap,
    /// By pixel, pixels.
    heights_px: Vec<f32>,
}

impl Canvas {
    /// Bare: nothing stands on the picture yet, every height is 0.
    pub fn new(pixmap: Pixmap) -> Self {
        let heights_px = vec![0.0; pixmap.pixels().len()];
        Self { pixmap, heights_px }
    }

    /// Bare again, over a background of the same size.
    pub fn reset(&mut self, background: &Pixmap) {
        self.pixmap.data_mut().copy_from_slice(background.data());
        self.heights_px.fill(0.0);
    }

    /// Paints a shaded limb with smooth edges, hidden by what lies higher, and within `rim_px` a dark rim on what lies
    /// clearly lower: so an arm stands out from the trunk, and upper arm and forearm run into each other.
    pub fn paint(&mut self, cone: &Cone, colour: Rgb, rim_px: f32) {
        let field = Field::new(cone);
        let (width, height) = (self.pixmap.width(), self.pixmap.height());
        let window = Window::around(cone, 0.5 + rim_px, width, height);
        let pixels = pixels_mut(&mut self.pixmap);
        for y in window.rows() {
            let row = y * width as usize;
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

/// One pixel of a limb: hidden, rim, edge or surface.
fn paint_pixel(pixel: &mut Pixel, below_px: &mut f32, surface: &Surface, distance: f32, colour: Rgb, rim_px: f32) {
    let coverage = (0.5 - distance).clamp(0.0, 1.0);
    let mut mixed = to_vec(*pixel);
    if coverage < 1.0 && rim_px > 0.0 {
        let nearness = 1.0 - distance.max(0.0) / (0.5 + rim_px);
        let drop = ((surface.axis_px - *below_px) / (RIM_DROP * rim_px)).clamp(0.0, 1.0);
        mixed *= 1.0 - RIM_DARKNESS * nearness * nearness * drop;
    }
    // Where two surfaces cut each other, the nearer one takes over within a pixel of height, so that the seam is
    // smooth.
    let visible = coverage * (0.5 + surface.top_px - *below_px).clamp(0.0, 1.0);
    mixed = mixed.lerp((colour * surface.light).min(Vec3::ONE), visible);
    if visible >= 0.5 {
        *below_px = surface.top_px;
    }
    *pixel = to_pixel(mixed);
}

/// Adds a cone's outline to a mask of shade, as the maximum of both, with an edge that is `softness_px` wide.
pub(crate) fn shade(mask: &mut [u8], [width, height]: [u32; 2], cone: &Cone, softness_px: f32) {
    let field = Field::new(cone);
    let window = Window::around(cone, softness_px, width, height);
    for y in window.rows() {
        let row = &mut mask[y * width as usize..][..width as usize];
        for x in field.columns(&window, y, softness_px) {
            let distance = field.distance(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
            let depth = (0.5 - 0.5 * distance / softness_px).clamp(0.0, 1.0);
            let smooth = depth * depth * (3.0 - 2.0 * depth);
            row[x] = row[x].max((255.0 * smooth + 0.5) as u8);
        }
    }
}

/// A cone made ready for many queries.
struct Field {
    start: Vec2,
    axis: Vec2,
    inverse_length_squared: f32,
    length: f32,
    radii: [f32; 2],
    heights: [f32; 2],
    /// Cosine and sine of the flank's slope against the axis.
    slope: Vec2,
}

/// What the eye sees of a cone at one point.
struct Surface {
    /// Height of the bone, pixels.
    axis_px: f32,
    /// Height of the skin, pixels.
    top_px: f32,
    /// Share of the light that it reflects.
    light: f32,
}

impl Field {
    fn new(cone: &Cone) -> Self {
        let [start, end] = cone.ends_px;
        let [from, to] = cone.radii_px;
        // Where one end's ball hides the other from above, only the greater one is seen.
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

    /// Signed distance to the outline: negative inside.
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

    /// The columns of a row that lie no farther from the axis's line than the greater radius and a margin: for a limb
    /// that lies across its window, a fraction of it.
    fn columns(&self, window: &Window, row: usize, margin_px: f32) -> Range<usize> {
        let columns = window.columns();
        if self.axis.y.abs() < 0.05 * self.length {
            return columns;
        }
        let middle = self.start.x + (row as f32 + 0.5 - self.start.y) * self.axis.x / self.axis.y;
        let reach = (self.radii[0].max(self.radii[1]) + margin_px) * self.length / self.axis.y.abs() + 1.0;
        // Casts saturate, as in Window::between.
        let (first, last) = ((middle - reach).max(0.0) as usize, (middle + reach).max(0.0) as usize);
        columns.start.max(first)..columns.end.min(last)
    }

    fn surface(&self, point: Vec2) -> Surface {
        let offset = point - self.start;
        let along = (offset.dot(self.axis) * self.inverse_length_squared).clamp(0.0, 1.0);
        let radius = self.radii[0] + along * (self.radii[1] - self.radii[0]);
        let tilt = (offset - along * self.axis) / radius.max(1e-3);
        let steepness = tilt.length_squared();
        // At the outline's soft edge, just outside, the surface is that of the rim.
        let normal =
            if steepness < 1.0 { tilt.extend((1.0 - steepness).sqrt()) } else { (tilt / steepness.sqrt()).extend(0.0) };
        let axis_px = self.heights[0] + along * (self.heights[1] - self.heights[0]);
        Surface { axis_px, top_px: axis_px + radius * normal.z, light: AMBIENT + DIFFUSE * normal.dot(LIGHT).max(0.0) }
    }
}

/// The pixels that a shape can touch, clipped to the picture.
pub(crate) struct Window {
    low: [usize; 2],
    high: [usize; 2],
}

impl Window {
    fn around(cone: &Cone, margin_px: f32, width: u32, height: u32) -> Self {
        let [start, end] = cone.ends_px.map(Vec3::truncate);
        let [from, to] = cone.radii_px.map(|radius| Vec2::splat(radius + margin_px));
        Self::between((start - from).min(end - to), (start + from).max(end + to), width, height)
    }

    pub(crate) fn between(low: Vec2, high: Vec2, width: u32, height: u32) -> Self {
        // Casts saturate: what lies left of or above the picture becomes 0, what is not finite an empty window.
        let clip = |value: f32, side: u32| (value.max(0.0) as usize).min(side as usize);
        Self {
            low: [clip(low.x.floor(), width), clip(low.y.floor(), height)],
            high: [clip(high.x.ceil(), width), clip(high.y.ceil(), height)],
        }
    }

    pub(crate) fn rows(&self) -> Range<usize> {
        self.low[1]..self.high[1]
    }

    pub(crate) fn columns(&self) -> Range<usize> {
        self.low[0]..self.high[0]
    }
}

/// Red, green, blue, alpha of an opaque pixel.
pub(crate) type Pixel = [u8; 4];

/// All pixels of a picture, row by row: plain bytes, for kernels that read and write each pixel once.
pub(crate) fn pixels_mut(pixmap: &mut Pixmap) -> &mut [Pixel] {
    pixmap.data_mut().as_chunks_mut().0
}

/// An opaque pixel's colour, 0 to 1.
pub(crate) fn to_vec(pixel: Pixel) -> Vec3 {
    let [red, green, blue, _] = pixel.map(f32::from);
    Vec3::new(red, green, blue) * (1.0 / 255.0)
}

/// An opaque pixel; colours within 0 to 1.
pub(crate) fn to_pixel(colour: Vec3) -> Pixel {
    let [red, green, blue] = (colour * 255.0 + 0.5).to_array().map(|value| value as u8);
    [red, green, blue, u8::MAX]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance to the union of many discs along the bone: the definition.
    fn brute_force_distance(cone: &Cone, point: Vec2) -> f32 {
        (0..=4000)
            .map(|step| {
                let share = step as f32 / 4000.0;
                let centre = cone.ends_px[0].lerp(cone.ends_px[1], share).truncate();
                point.distance(centre) - (cone.radii_px[0] + share * (cone.radii_px[1] - cone.radii_px[0]))
            })
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn distance_is_that_to_the_swept_discs() {
        let ends_px = [Vec3::new(10.0, 12.0, 0.0), Vec3::new(31.0, 25.0, 4.0)];
        for radii_px in [[5.0, 5.0], [7.0, 2.0], [1.0, 9.0], [40.0, 3.0], [2.0, 50.0]] {
            let cone = Cone { ends_px, radii_px };
            let field = Field::new(&cone);
            for y in 0..40 {
                for x in 0..40 {
                    let point = Vec2::new(x as f32, y as f32);
                    let (found, truth) = (field.distance(point), brute_force_distance(&cone, point));
                    // Inside, the swept discs' own minimum lies deeper than the distance to the outline; only signs
                    // must agree.
                    let same = if truth > 0.0 { (found - truth).abs() < 0.02 } else { found < 0.02 };
                    assert!(same, "{radii_px:?} {point} {found} {truth}");
                }
            }
        }
    }

    #[test]
    fn shapes_outside_the_picture_or_without_a_place_touch_nothing() {
        let mut canvas = Canvas::new(Pixmap::new(8, 8).unwrap());
        for place in [-50.0, 90.0, f32::NAN, f32::INFINITY] {
            let cone = Cone { ends_px: [Vec3::splat(place); 2], radii_px: [3.0; 2] };
            canvas.paint(&cone, Vec3::ONE, 1.0);
        }
        assert!(canvas.pixmap.data().iter().all(|byte| *byte == 0));
    }
}

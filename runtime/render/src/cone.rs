//! The one kernel behind bodies and their shadows: a ball swept along a bone while its radius changes, seen from above.
//!
//! tiny-skia fills paths with flat colours and gradients; a limb needs a rounded shade across and a soft edge, for twenty limbs of a
//! thousand bodies. So each limb is painted from its distance field (the uneven capsule of I. Quilez, "2D distance functions"): coverage
//! from the distance, the surface's normal from the offset to the bone. All in pixels, x right, y down; z towards the eye.

use glam::{Vec2, Vec3};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::palette::Rgb;

/// Towards the light: from the upper left, above the eye, so that tops stay bright.
const LIGHT: Vec3 = Vec3::new(-0.424, -0.530, 0.734);
/// Light that reaches every side.
const AMBIENT: f32 = 0.66;
/// Light that a surface facing [`LIGHT`] gets on top; a surface facing the eye then has 0.66 + 0.46·0.734 ≈ 1.
const DIFFUSE: f32 = 0.46;
/// Darkness of the rim that a limb casts on what lies close below, at its edge.
const RIM_DARKNESS: f32 = 0.34;

/// A swept ball in the picture plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centres of the ball at both ends, pixels.
    pub ends_px: [Vec2; 2],
    /// Its radii there, pixels.
    pub radii_px: [f32; 2],
}

/// A cone made ready for many distance queries.
struct Field {
    start: Vec2,
    axis: Vec2,
    length_squared: f32,
    radii: [f32; 2],
    /// Sine and cosine (times the length) of the flank's slope against the axis.
    slope: Vec2,
}

impl Field {
    fn new(cone: &Cone) -> Self {
        let [start, end] = cone.ends_px;
        let [from, to] = cone.radii_px;
        let axis = end - start;
        // Where one end's ball hides the other, only the greater one is seen.
        let hidden = axis.length_squared() <= (from - to) * (from - to) + 1e-6;
        let start = if hidden && to > from { end } else { start };
        let radii = if hidden { [from.max(to); 2] } else { [from, to] };
        let axis = if hidden { Vec2::new(1e-3, 0.0) } else { axis };
        let length_squared = axis.length_squared();
        let taper = radii[0] - radii[1];
        Self { start, axis, length_squared, radii, slope: Vec2::new((length_squared - taper * taper).sqrt(), taper) }
    }

    /// Signed distance to the outline: negative inside.
    fn distance(&self, point: Vec2) -> f32 {
        let offset = point - self.start;
        let across = offset.perp_dot(self.axis).abs() / self.length_squared;
        let along = offset.dot(self.axis) / self.length_squared;
        let on_flank = self.slope.x * along - self.slope.y * across;
        let squared = across * across + along * along;
        if on_flank < 0.0 {
            (self.length_squared * squared).sqrt() - self.radii[0]
        } else if on_flank > self.slope.x {
            (self.length_squared * (squared + 1.0 - 2.0 * along)).max(0.0).sqrt() - self.radii[1]
        } else {
            self.slope.x * across + self.slope.y * along - self.radii[0]
        }
    }

    /// How much light the surface under a point inside reflects.
    fn shade(&self, point: Vec2) -> f32 {
        let offset = point - self.start;
        let along = (offset.dot(self.axis) / self.length_squared).clamp(0.0, 1.0);
        let radius = self.radii[0] + along * (self.radii[1] - self.radii[0]);
        let tilt = ((offset - along * self.axis) / radius.max(1e-3)).clamp_length_max(1.0);
        let normal = tilt.extend((1.0 - tilt.length_squared()).max(0.0).sqrt());
        AMBIENT + DIFFUSE * normal.dot(LIGHT).max(0.0)
    }
}

/// Paints a shaded limb with smooth edges over an opaque picture, and a dark rim of `rim_px` on what it passes over.
pub fn paint(pixmap: &mut Pixmap, cone: &Cone, colour: Rgb, rim_px: f32) {
    let field = Field::new(cone);
    let window = Window::around(cone, 0.5 + rim_px, pixmap.width(), pixmap.height());
    let width = pixmap.width() as usize;
    let pixels = pixmap.pixels_mut();
    for y in window.rows() {
        for x in window.columns() {
            let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let distance = field.distance(centre);
            if distance >= 0.5 + rim_px {
                continue;
            }
            let pixel = &mut pixels[y * width + x];
            let mut below = to_vec(*pixel);
            if distance > -0.5 && rim_px > 0.0 {
                let nearness = 1.0 - distance.max(0.0) / (0.5 + rim_px);
                below *= 1.0 - RIM_DARKNESS * nearness * nearness;
            }
            let coverage = (0.5 - distance).clamp(0.0, 1.0);
            let lit = if coverage > 0.0 { (colour * field.shade(centre)).min(Vec3::ONE) } else { below };
            *pixel = to_pixel(below.lerp(lit, coverage));
        }
    }
}

/// Adds a cone to a mask of shade, as the maximum of both, with an edge that is `softness_px` wide.
pub fn shade(mask: &mut [u8], [width, height]: [u32; 2], cone: &Cone, softness_px: f32) {
    let field = Field::new(cone);
    let window = Window::around(cone, softness_px, width, height);
    for y in window.rows() {
        let row = &mut mask[y * width as usize..][..width as usize];
        for x in window.columns() {
            let distance = field.distance(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
            let depth = (0.5 - 0.5 * distance / softness_px).clamp(0.0, 1.0);
            let smooth = depth * depth * (3.0 - 2.0 * depth);
            row[x] = row[x].max((255.0 * smooth + 0.5) as u8);
        }
    }
}

/// The pixels that a shape can touch, clipped to the picture.
pub(crate) struct Window {
    low: [usize; 2],
    high: [usize; 2],
}

impl Window {
    fn around(cone: &Cone, margin_px: f32, width: u32, height: u32) -> Self {
        let [start, end] = cone.ends_px;
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

    pub(crate) fn rows(&self) -> std::ops::Range<usize> {
        self.low[1]..self.high[1]
    }

    pub(crate) fn columns(&self) -> std::ops::Range<usize> {
        self.low[0]..self.high[0]
    }
}

/// An opaque pixel's colour, 0 to 1.
pub(crate) fn to_vec(pixel: PremultipliedColorU8) -> Vec3 {
    Vec3::new(f32::from(pixel.red()), f32::from(pixel.green()), f32::from(pixel.blue())) / 255.0
}

/// An opaque pixel; colours within 0 to 1.
pub(crate) fn to_pixel(colour: Vec3) -> PremultipliedColorU8 {
    let [red, green, blue] = (colour * 255.0 + 0.5).to_array().map(|value| value as u8);
    PremultipliedColorU8::from_rgba(red, green, blue, u8::MAX).expect("no channel exceeds full opacity")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance to the union of many discs along the bone: the definition.
    fn brute_force_distance(cone: &Cone, point: Vec2) -> f32 {
        (0..=4000)
            .map(|step| {
                let share = step as f32 / 4000.0;
                let centre = cone.ends_px[0].lerp(cone.ends_px[1], share);
                point.distance(centre) - (cone.radii_px[0] + share * (cone.radii_px[1] - cone.radii_px[0]))
            })
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn distance_is_that_to_the_swept_discs() {
        let ends = [Vec2::new(10.0, 12.0), Vec2::new(31.0, 25.0)];
        for radii_px in [[5.0, 5.0], [7.0, 2.0], [1.0, 9.0], [40.0, 3.0], [2.0, 50.0]] {
            let cone = Cone { ends_px: ends, radii_px };
            let field = Field::new(&cone);
            for y in 0..40 {
                for x in 0..40 {
                    let point = Vec2::new(x as f32, y as f32);
                    let (found, truth) = (field.distance(point), brute_force_distance(&cone, point));
                    // Inside, the swept discs' own minimum lies deeper than the distance to the outline; only signs must agree.
                    let same = if truth > 0.0 { (found - truth).abs() < 0.02 } else { found < 0.02 };
                    assert!(same, "{radii_px:?} {point} {found} {truth}");
                }
            }
        }
    }

    #[test]
    fn shapes_outside_the_picture_or_without_a_place_touch_nothing() {
        let mut pixmap = Pixmap::new(8, 8).unwrap();
        for place in [-50.0, 90.0, f32::NAN, f32::INFINITY] {
            let cone = Cone { ends_px: [Vec2::splat(place); 2], radii_px: [3.0; 2] };
            paint(&mut pixmap, &cone, Vec3::ONE, 1.0);
        }
        assert!(pixmap.data().iter().all(|byte| *byte == 0));
    }
}

//! Pixels of opaque pictures: plain bytes, for kernels that read and write each pixel once; and windows of pixels.
//!
//! Positions in pixels, x right, y down; colours sRGB-encoded, 0 to 1.

use std::ops::Range;

use glam::{Vec2, Vec3};
use tiny_skia::Pixmap;

/// Greatest side of a picture, pixels: that of 16k film scans; a larger frame takes gigabytes.
pub(crate) const MAX_SIDE_PX: u32 = 16_384;

/// Red, green, blue and alpha of an opaque pixel.
pub(crate) type Pixel = [u8; 4];

/// All pixels of a picture, row by row.
pub(crate) fn pixels_mut(pixmap: &mut Pixmap) -> &mut [Pixel] {
    pixmap.data_mut().as_chunks_mut().0
}

/// Colour of an opaque pixel, 0 to 1.
pub(crate) fn to_vec(pixel: Pixel) -> Vec3 {
    let [red, green, blue, _] = pixel.map(f32::from);
    Vec3::new(red, green, blue) * (1.0 / 255.0)
}

/// The opaque pixel of a colour within 0 to 1.
pub(crate) fn to_pixel(colour: Vec3) -> Pixel {
    let [red, green, blue] = (colour * 255.0 + 0.5).to_array().map(|value| value as u8);
    [red, green, blue, u8::MAX]
}

/// Blends a colour over an opaque pixel.
pub(crate) fn blend(pixel: &mut Pixel, colour: Vec3, opacity: f32) {
    *pixel = to_pixel(to_vec(*pixel).lerp(colour, opacity));
}

/// The pixels that a shape can touch, clipped to the picture.
pub(crate) struct PixelWindow {
    low: [usize; 2],
    high: [usize; 2],
}

impl PixelWindow {
    /// The window between two corners in a picture of this width and height, pixels.
    pub(crate) fn between(low: Vec2, high: Vec2, width: u32, height: u32) -> Self {
        // Casts saturate: left of or above the picture becomes 0, and a corner that is not finite an empty window.
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

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

/// Rows of a picture that a buffer of pixels holds. Positions stay those of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Strip {
    /// Width of the picture, pixels.
    pub(crate) width_px: u32,
    /// First row.
    pub(crate) top_px: u32,
    /// Number of rows.
    pub(crate) rows: u32,
}

impl Strip {
    /// All rows of a picture.
    pub(crate) fn whole(width_px: u32, height_px: u32) -> Self {
        Self { width_px, top_px: 0, rows: height_px }
    }

    /// Number of pixels.
    pub(crate) fn pixel_count(&self) -> usize {
        self.width_px as usize * self.rows as usize
    }

    /// Index of the first pixel of one of its rows.
    pub(crate) fn row_start(&self, row: usize) -> usize {
        (row - self.top_px as usize) * self.width_px as usize
    }
}

/// The pixels that a shape can touch, clipped to a strip.
pub(crate) struct PixelWindow {
    low: [usize; 2],
    high: [usize; 2],
}

impl PixelWindow {
    /// The window between two corners, pixels.
    pub(crate) fn between(low: Vec2, high: Vec2, strip: &Strip) -> Self {
        let &Strip { width_px, top_px, rows } = strip;
        // Casts saturate: left of or above the picture becomes 0, and a corner that is not finite an empty window.
        let clip = |value: f32, first: u32, end: u32| (value.max(0.0) as usize).clamp(first as usize, end as usize);
        Self {
            low: [clip(low.x.floor(), 0, width_px), clip(low.y.floor(), top_px, top_px + rows)],
            high: [clip(high.x.ceil(), 0, width_px), clip(high.y.ceil(), top_px, top_px + rows)],
        }
    }

    pub(crate) fn rows(&self) -> Range<usize> {
        self.low[1]..self.high[1]
    }

    pub(crate) fn columns(&self) -> Range<usize> {
        self.low[0]..self.high[0]
    }
}

//! A picture as EXR: scene-linear Rec. 709, half floats, premultiplied. The same picture gives the same bytes.
//!
//! Only attributes with a named field in the `exr` crate are written: it stores others in a hash map, whose order
//! changes from run to run. Lines are written in increasing order by one thread. No date is written.

use std::io::{self, Cursor};
use std::path::Path;

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2, WritableImage, f16,
};
use motiondb::files::atomic_file;
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::error::RenderError;
use crate::raster::palette::decode_srgb;

/// Primaries and white point of Rec. 709, the same as sRGB's.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};
/// Encoding: scan lines, 16 in one compressed block.
const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: exr::image::Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Writes a picture, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, pixmap: &Pixmap, frame_rate_hz: f32) -> Result<(), RenderError> {
    let written = encode(pixmap, frame_rate_hz).and_then(|bytes| atomic_file::write(path, &bytes));
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

fn encode(pixmap: &Pixmap, frame_rate_hz: f32) -> io::Result<Vec<u8>> {
    let linear = Linearizer::new();
    let (width, pixels) = (pixmap.width() as usize, pixmap.pixels());
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| linear.premultiplied(pixels[at.y() * width + at.x()]));
    let attributes = LayerAttributes {
        frames_per_second: Some(frame_rate_fraction(frame_rate_hz)),
        software_name: Some(Text::from("FbCrowd")),
        ..LayerAttributes::default()
    };
    let layer = Layer::new((width, pixmap.height() as usize), attributes, ENCODING, channels);
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(REC_709);
    let mut bytes = Cursor::new(Vec::new());
    // Frames are drawn in parallel already, so a single thread writes each.
    image.write().non_parallel().to_buffered(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.into_inner())
}

/// Conversion of code values to linear light, with a table for opaque pixels.
struct Linearizer {
    /// Linear light of each code value of an opaque pixel.
    opaque: [f32; 256],
}

impl Linearizer {
    fn new() -> Self {
        Self { opaque: std::array::from_fn(|code| decode_srgb(code as f32 / 255.0)) }
    }

    /// A pixel in linear light, premultiplied. tiny-skia's pixels are premultiplied code values.
    fn premultiplied(&self, pixel: PremultipliedColorU8) -> (f16, f16, f16, f16) {
        let alpha = f32::from(pixel.alpha()) / 255.0;
        let linear = |code: u8| match pixel.alpha() {
            u8::MAX => self.opaque[usize::from(code)],
            0 => 0.0,
            covered => decode_srgb(f32::from(code) / f32::from(covered)) * alpha,
        };
        let [red, green, blue] = [pixel.red(), pixel.green(), pixel.blue()].map(linear).map(f16::from_f32);
        (red, green, blue, f16::from_f32(alpha))
    }
}

/// A frame rate as a fraction: a whole number, a broadcast rate n·1000/1001, or thousandths.
fn frame_rate_fraction(frame_rate_hz: f32) -> (i32, u32) {
    let (whole, broadcast) = (frame_rate_hz.round(), (frame_rate_hz * 1.001).round());
    if (frame_rate_hz - whole).abs() < 1e-4 {
        (whole as i32, 1)
    } else if (frame_rate_hz * 1.001 - broadcast).abs() < 1e-3 {
        (broadcast as i32 * 1000, 1001)
    } else {
        ((frame_rate_hz * 1000.0).round() as i32, 1000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_rates_become_exact_fractions() {
        for (rate, fraction) in
            [(30.0, (30, 1)), (29.97, (30_000, 1001)), (23.976, (24_000, 1001)), (12.5, (12_500, 1000))]
        {
            assert_eq!(frame_rate_fraction(rate), fraction, "{rate}");
        }
    }

    #[test]
    fn half_covered_white_stays_white() {
        let pixel = PremultipliedColorU8::from_rgba(128, 128, 128, 128).unwrap();
        let (red, _, _, alpha) = Linearizer::new().premultiplied(pixel);
        assert!((red.to_f32() - alpha.to_f32()).abs() < 1e-3);
    }
}

//! A picture as EXR: scene-linear Rec. 709, half floats, premultiplied. The same picture gives the same bytes.
//!
//! Only attributes with a named field in the `exr` crate are written: it stores others in a hash map, whose order
//! changes from run to run. Lines are written in increasing order by one thread. No date is written.

use std::io::{self, Seek, Write};
use std::path::Path;

use exr::block::writer::ChunksWriter;
use exr::image::write::channels::{ChannelsWriter, WritableChannels};
use exr::meta::Headers;
use exr::prelude::{
    Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2, WritableImage, f16,
};
use motiondb::files::atomic_file::AtomicFile;
use tiny_skia::PremultipliedColorU8;

use crate::error::RenderError;
use crate::raster::colour_space::ColourSpace;
use crate::raster::palette::decode_srgb;
use crate::raster::strips::PictureStrips;

/// Number of lines in one compressed block.
const BLOCK_LINES: usize = 16;
/// Encoding: scan lines in blocks of [`BLOCK_LINES`].
const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: exr::image::Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Writes a picture that is drawn strip by strip, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, picture: &mut impl PictureStrips, frame_rate_hz: f32) -> Result<(), RenderError> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        encode(file.writer(), picture, frame_rate_hz)?;
        file.commit()
    });
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Encodes a picture block by block. Frames are drawn in parallel already, so a single thread encodes each.
fn encode(out: impl Write + Seek, picture: &mut impl PictureStrips, frame_rate_hz: f32) -> io::Result<()> {
    let linear = Linearizer::new();
    let [width, height] = picture.size_px().map(|side| side as usize);
    let strip_rows = picture.strip_rows() as usize;
    // Blocks of lines do not extend over two strips.
    debug_assert!(strip_rows.is_multiple_of(BLOCK_LINES) || strip_rows >= height);
    let mut next_strip = 0;
    let written = exr::block::write(out, headers((width, height), frame_rate_hz), true, |meta, chunks| {
        let blocks = meta.collect_ordered_block_data(|block| {
            if block.pixel_position.y() >= next_strip {
                picture.draw(next_strip as u32);
                next_strip += strip_rows;
            }
            let (pixels, top) = (picture.pixels(), next_strip - strip_rows);
            let pixel = |at: Vec2<usize>| linear.premultiplied(pixels[(at.y() - top) * width + at.x()]);
            let channels = SpecificChannels::rgba(pixel);
            channels.create_writer(&meta.headers[0]).extract_uncompressed_block(&meta.headers[0], block)
        });
        let mut compressor = chunks.sequential_blocks_compressor(&meta);
        for (index, block) in blocks {
            compressor.compress_block(index, block)?;
        }
        Ok(())
    });
    written.map_err(io::Error::other)
}

/// The header of a file of one layer.
fn headers((width, height): (usize, usize), frame_rate_hz: f32) -> Headers {
    let attributes = LayerAttributes {
        frames_per_second: Some(frame_rate_fraction(frame_rate_hz)),
        software_name: Some(Text::from("FbCrowd")),
        ..LayerAttributes::default()
    };
    // The header depends on the types of the channels alone.
    let channels = SpecificChannels::rgba(|_: Vec2<usize>| (f16::ZERO, f16::ZERO, f16::ZERO, f16::ZERO));
    let mut image = Image::from_layer(Layer::new((width, height), attributes, ENCODING, channels));
    image.attributes.chromaticities = Some(ColourSpace::Rec709.chromaticities());
    image.write().infer_meta_data()
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
pub(crate) fn frame_rate_fraction(frame_rate_hz: f32) -> (i32, u32) {
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

//! A picture as EXR: scene-linear Rec. 709, half floats, premultiplied. The same picture gives the same bytes.
//!
//! No date is written. Number and time of a frame are written where a shot is stated.

use std::io::{self, Seek, Write};
use std::ops::Range;
use std::path::Path;

use exr::meta::Headers;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2, WritableImage, f16,
};
use fbcrowd_sim::scenario::FrameRate;
use motiondb::files::atomic_file::AtomicFile;
use tiny_skia::PremultipliedColorU8;

use crate::error::RenderError;
use crate::raster::colour_space::ColourSpace;
use crate::raster::palette::decode_srgb;
use crate::raster::scan_lines::{self, STRIP_STEP};
use crate::raster::strips::PictureStrips;

/// Encoding: scan lines in blocks of sixteen.
const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: exr::image::Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Writes a picture that is drawn strip by strip, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, picture: &mut impl PictureStrips, frame: &FrameLabel) -> Result<(), RenderError> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        encode(file.writer(), picture, frame)?;
        file.commit()
    });
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Encodes a picture strip by strip.
fn encode(out: &mut (impl Write + Seek), picture: &mut impl PictureStrips, frame: &FrameLabel) -> io::Result<()> {
    let linear = Linearizer::new();
    let [width, height] = picture.size_px().map(|side| side as usize);
    let strip_rows = picture.strip_rows() as usize;
    // Strips of a picture in several strips end where blocks of lines do.
    debug_assert!(strip_rows.is_multiple_of(STRIP_STEP) || strip_rows >= height);
    let strip = |lines: Range<usize>| {
        picture.draw(lines.start as u32);
        Ok((lines.start, picture.pixels()[..lines.len() * width].to_vec()))
    };
    let line = |(top, pixels): &(usize, Vec<PremultipliedColorU8>), y: usize, bytes: &mut Vec<u8>| {
        let pixels = &pixels[(y - top) * width..][..width];
        let light: Vec<[f16; 4]> = pixels.iter().map(|pixel| linear.premultiplied(*pixel)).collect();
        // In the order of the channels' names: A, B, G, R.
        for side in [3, 2, 1, 0] {
            light.iter().for_each(|light| bytes.extend(light[side].to_ne_bytes()));
        }
    };
    scan_lines::write(out, headers((width, height), frame), strip_rows, strip, line)
}

/// The header of a file of one layer.
fn headers((width, height): (usize, usize), frame: &FrameLabel) -> Headers {
    let mut attributes = LayerAttributes {
        frames_per_second: Some(rational(frame.rate)),
        software_name: Some(Text::from("FbCrowd")),
        ..LayerAttributes::default()
    };
    if let Some((number, time_s)) = frame.moment {
        append_moment(&mut attributes, number, time_s);
    }
    // The header depends on the types of the channels alone.
    let channels = SpecificChannels::rgba(|_: Vec2<usize>| (f16::ZERO, f16::ZERO, f16::ZERO, f16::ZERO));
    let mut image = Image::from_layer(Layer::new((width, height), attributes, ENCODING, channels));
    image.attributes.chromaticities = Some(ColourSpace::Rec709.chromaticities());
    image.write().infer_meta_data()
}

/// What a header states of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameLabel {
    /// Frame rate.
    pub(crate) rate: FrameRate,
    /// Number and simulated time (s) of the frame of a stated shot.
    pub(crate) moment: Option<(u32, f64)>,
}

/// Adds number and simulated time (s) of a frame.
pub(crate) fn append_moment(attributes: &mut LayerAttributes, number: u32, time_s: f64) {
    let number = i32::try_from(number).unwrap_or(i32::MAX);
    attributes.other.insert(Text::from("imageCounter"), AttributeValue::I32(number));
    attributes.other.insert(Text::from("time_s"), AttributeValue::F32(time_s as f32));
}

/// A frame rate as an attribute.
pub(crate) fn rational(rate: FrameRate) -> (i32, u32) {
    (i32::try_from(rate.frames).unwrap_or(i32::MAX), rate.seconds)
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
    fn premultiplied(&self, pixel: PremultipliedColorU8) -> [f16; 4] {
        let alpha = f32::from(pixel.alpha()) / 255.0;
        let linear = |code: u8| match pixel.alpha() {
            u8::MAX => self.opaque[usize::from(code)],
            0 => 0.0,
            covered => decode_srgb(f32::from(code) / f32::from(covered)) * alpha,
        };
        let [red, green, blue] = [pixel.red(), pixel.green(), pixel.blue()].map(linear).map(f16::from_f32);
        [red, green, blue, f16::from_f32(alpha)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_covered_white_stays_white() {
        let pixel = PremultipliedColorU8::from_rgba(128, 128, 128, 128).unwrap();
        let [red, _, _, alpha] = Linearizer::new().premultiplied(pixel);
        assert!((red.to_f32() - alpha.to_f32()).abs() < 1e-3);
    }
}

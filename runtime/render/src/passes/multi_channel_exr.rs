//! A frame with its passes as an EXR file of one part. The same frame gives the same bytes, on any number of threads.

use std::io::{self, Seek, Write};
use std::ops::Range;
use std::path::Path;

use exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers};
use exr::prelude::{Compression, LayerAttributes, LineOrder, Text, f16};
use fbcrowd_sim::scenario::FrameRate;
use motiondb::files::atomic_file::AtomicFile;
use rayon::prelude::*;

use crate::error::RenderError;
use crate::passes::camera_matrices::{world_to_camera, world_to_normalized_device};
use crate::passes::tile_passes::{Channel, ChannelKind};
use crate::raster::colour_space::ColourSpace;
use crate::raster::exr_frame::rational;
use crate::raster::scan_lines::{self, STRIP_STEP};
use crate::visibility::lens::NEAR_M;
use crate::visibility::{Lens, TILE_PX};

/// How the lines of an EXR file are compressed; all are lossless.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExrCompression {
    /// Deflate in blocks of sixteen lines: small, and read fast by most programs.
    #[default]
    Zip16,
    /// Deflate line by line.
    Zip1,
    /// Runs of equal bytes: written fast, about twice as large.
    Rle,
    /// Wavelets.
    Piz,
    /// None.
    Uncompressed,
}

impl ExrCompression {
    fn in_file(self) -> Compression {
        match self {
            Self::Zip16 => Compression::ZIP16,
            Self::Zip1 => Compression::ZIP1,
            Self::Rle => Compression::RLE,
            Self::Piz => Compression::PIZ,
            Self::Uncompressed => Compression::Uncompressed,
        }
    }
}

/// A frame that is to be written.
#[derive(Debug)]
pub(crate) struct PassFrame<'a> {
    /// Channels beside the picture, in the order of a tile's values.
    pub(crate) channels: &'a [Channel],
    /// Attributes of the mattes.
    pub(crate) metadata: Vec<(String, String)>,
    pub(crate) lens: &'a Lens,
    pub(crate) number: u32,
    pub(crate) rate: FrameRate,
    /// Simulated time of a stated shot's frame, s.
    pub(crate) time_s: Option<f64>,
    pub(crate) colour_space: ColourSpace,
    pub(crate) compression: ExrCompression,
}

/// Pixels of a tile, and the values of its channels, pixel by pixel.
pub(crate) type DrawnTile = (Vec<[f16; 4]>, Vec<f32>);

/// Greatest number of pixels of a strip, which take 12 bytes each, and 4 more for each channel.
pub(crate) const STRIP_PIXELS: usize = 1 << 20;

/// Writes a frame, complete or not at all. `draw` gives the tiles of some rows of tiles.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(
    path: &Path,
    frame: &PassFrame<'_>,
    draw: impl FnMut(Range<u32>) -> Vec<DrawnTile>,
) -> Result<(), RenderError> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        encode(file.writer(), frame, draw)?;
        file.commit()
    });
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Encodes a frame strip by strip.
fn encode(
    out: &mut (impl Write + Seek),
    frame: &PassFrame<'_>,
    mut draw: impl FnMut(Range<u32>) -> Vec<DrawnTile>,
) -> io::Result<()> {
    let [width, _] = frame.lens.size_px.map(|side| side as usize);
    let (headers, order) = headers(frame);
    let strip = |lines: Range<usize>| {
        let rows = lines.start as u32 / TILE_PX..(lines.end as u32).div_ceil(TILE_PX);
        let top = (rows.start * TILE_PX) as usize;
        let mut tiles = draw(rows);
        if frame.colour_space != ColourSpace::Rec709 {
            tiles.par_iter_mut().flat_map(|(pixels, _)| pixels).for_each(|pixel| {
                *pixel = frame.colour_space.of_rec_709(*pixel);
            });
        }
        Ok(Strip { tiles, top, width, channels: frame.channels.len() })
    };
    let line = |strip: &Strip, y: usize, bytes: &mut Vec<u8>| {
        order.iter().for_each(|channel| strip.append_line(y, *channel, bytes));
    };
    scan_lines::write(out, headers, STRIP_PIXELS / width / STRIP_STEP * STRIP_STEP, strip, line)
}

/// Where the samples of a channel come from, and their type.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// Red, green, blue or alpha.
    Light(usize),
    /// A channel of the passes.
    Pass(usize, ChannelKind),
}

/// The header, and the source of each of its channels in their order, which is that of their names.
fn headers(frame: &PassFrame<'_>) -> (Headers, Vec<Source>) {
    let light = ["R", "G", "B", "A"].into_iter().enumerate();
    let light = light.map(|(side, name)| (name.to_owned(), Source::Light(side)));
    let passes = frame.channels.iter().enumerate();
    let passes = passes.map(|(index, channel)| (channel.name.clone(), Source::Pass(index, channel.kind)));
    let mut sources: Vec<(Text, Source)> =
        light.chain(passes).map(|(name, source)| (Text::from(name.as_str()), source)).collect();
    sources.sort_by(|(one, _), (other, _)| one.cmp(other));
    let description = |(name, source): &(Text, Source)| {
        let kind = match source {
            Source::Light(_) | Source::Pass(_, ChannelKind::Half) => SampleType::F16,
            Source::Pass(_, ChannelKind::Float) => SampleType::F32,
            Source::Pass(_, ChannelKind::Uint) => SampleType::U32,
        };
        ChannelDescription::named(name.clone(), kind)
    };
    let size = frame.lens.size_px.map(|side| side as usize);
    let mut header = Header::new(Text::from(""), (size[0], size[1]), sources.iter().map(description).collect())
        .with_encoding(frame.compression.in_file(), BlockDescription::ScanLines, LineOrder::Increasing);
    header.own_attributes = attributes(frame);
    header.shared_attributes.chromaticities = Some(frame.colour_space.chromaticities());
    (std::iter::once(header).collect(), sources.into_iter().map(|(_, source)| source).collect())
}

/// Some rows of tiles.
struct Strip {
    tiles: Vec<DrawnTile>,
    /// First line.
    top: usize,
    /// Width of the picture, pixels.
    width: usize,
    /// Number of channels of the passes.
    channels: usize,
}

impl Strip {
    /// Appends the samples of a channel along a line.
    fn append_line(&self, y: usize, source: Source, bytes: &mut Vec<u8>) {
        let (side, columns) = (TILE_PX as usize, self.width.div_ceil(TILE_PX as usize));
        let (row, line) = ((y - self.top) / side, (y - self.top) % side);
        for (column, (pixels, values)) in self.tiles[row * columns..][..columns].iter().enumerate() {
            let width = side.min(self.width - column * side);
            let of_line = line * width..(line + 1) * width;
            match source {
                Source::Light(side) => {
                    pixels[of_line].iter().for_each(|pixel| bytes.extend(pixel[side].to_ne_bytes()));
                }
                Source::Pass(index, kind) => {
                    let values = values[of_line.start * self.channels..of_line.end * self.channels].iter();
                    let values = values.skip(index).step_by(self.channels);
                    match kind {
                        ChannelKind::Half => values.for_each(|value| bytes.extend(f16::from_f32(*value).to_ne_bytes())),
                        // Whole numbers are stored as bits.
                        ChannelKind::Float | ChannelKind::Uint => {
                            values.for_each(|value| bytes.extend(value.to_ne_bytes()));
                        }
                    }
                }
            }
        }
    }
}

fn attributes(frame: &PassFrame<'_>) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        frames_per_second: Some(rational(frame.rate)),
        software_name: Some(Text::from("FbCrowd")),
        world_to_camera: Some(world_to_camera(frame.lens)),
        world_to_normalized_device: Some(world_to_normalized_device(frame.lens, NEAR_M)),
        near_clip_plane: Some(NEAR_M),
        ..LayerAttributes::default()
    };
    let frame_number = i32::try_from(frame.number).unwrap_or(i32::MAX);
    attributes.other.insert(Text::from("imageCounter"), AttributeValue::I32(frame_number));
    if let Some(time_s) = frame.time_s {
        attributes.other.insert(Text::from("time_s"), AttributeValue::F32(time_s as f32));
    }
    for (name, value) in &frame.metadata {
        attributes.other.insert(Text::from(name.as_str()), AttributeValue::Text(Text::from(value.as_str())));
    }
    attributes
}

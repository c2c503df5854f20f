//! A frame with its passes as an EXR file of one part. The same frame gives the same bytes, on any number of threads.

use std::io::{self, Cursor, Write};
use std::path::Path;

use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, Text,
    WritableImage, f16,
};
use motiondb::files::atomic_file::AtomicFile;

use crate::error::RenderError;
use crate::passes::camera_matrices::{world_to_camera, world_to_normalized_device};
use crate::passes::exr_header::sort_attributes;
use crate::passes::pass_picture::ChannelPicture;
use crate::raster::colour_space::ColourSpace;
use crate::raster::exr_frame::frame_rate_fraction;
use crate::shading::LinearPicture;
use crate::visibility::Lens;
use crate::visibility::lens::NEAR_M;

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
    pub(crate) picture: &'a LinearPicture,
    pub(crate) channels: Vec<ChannelPicture>,
    /// Attributes of the mattes.
    pub(crate) metadata: Vec<(String, String)>,
    pub(crate) lens: &'a Lens,
    pub(crate) number: u32,
    pub(crate) frame_rate_hz: f32,
    pub(crate) colour_space: ColourSpace,
    pub(crate) compression: ExrCompression,
}

/// Writes a frame, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write(path: &Path, frame: PassFrame<'_>) -> Result<(), RenderError> {
    let written = encode(frame).and_then(|bytes| {
        let mut file = AtomicFile::create(path)?;
        file.writer().write_all(&bytes)?;
        file.commit()
    });
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// The bytes of the file.
pub(crate) fn encode(frame: PassFrame<'_>) -> io::Result<Vec<u8>> {
    let size = frame.picture.size_px.map(|side| side as usize);
    let attributes = attributes(&frame);
    let encoding = Encoding {
        compression: frame.compression.in_file(),
        blocks: exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let light = |side: usize| {
        let pixels = frame.picture.pixels.iter();
        FlatSamples::F16(pixels.map(|pixel| frame.colour_space.of_rec_709(*pixel)[side]).collect::<Vec<f16>>())
    };
    let beauty = ["R", "G", "B", "A"].into_iter().enumerate().map(|(side, name)| AnyChannel::new(name, light(side)));
    let others = frame.channels.into_iter().map(|channel| AnyChannel::new(channel.name.as_str(), channel.samples));
    let channels = AnyChannels::sort(beauty.chain(others).collect());
    let mut image = Image::from_layer(Layer::new((size[0], size[1]), attributes, encoding, channels));
    image.attributes.chromaticities = Some(frame.colour_space.chromaticities());
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(io::Error::other)?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

fn attributes(frame: &PassFrame<'_>) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        frames_per_second: Some(frame_rate_fraction(frame.frame_rate_hz)),
        software_name: Some(Text::from("FbCrowd")),
        world_to_camera: Some(world_to_camera(frame.lens)),
        world_to_normalized_device: Some(world_to_normalized_device(frame.lens, NEAR_M)),
        near_clip_plane: Some(NEAR_M),
        ..LayerAttributes::default()
    };
    let frame_number = i32::try_from(frame.number).unwrap_or(i32::MAX);
    attributes.other.insert(Text::from("imageCounter"), AttributeValue::I32(frame_number));
    for (name, value) in &frame.metadata {
        attributes.other.insert(Text::from(name.as_str()), AttributeValue::Text(Text::from(value.as_str())));
    }
    attributes
}

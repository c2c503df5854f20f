//! Textures: PNG and JPEG, decoded one at a time within bounds; and their colours at texture coordinates.

use std::io::Cursor;
use std::path::Path;

use gltf::json::Root;
use gltf::json::texture::WrappingMode;
use gltf::json::validation::Checked;
use motiondb::character::{CharacterTexture, TEXTURE_SIDE_MAX, Wrap};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::character::reason::CharacterReason;
use crate::error::RejectionReason;
use crate::read::catch_panic;
use crate::read::gltf::buffers::{self, Outside};
use crate::read::gltf::document::Document;

/// Greatest width and height, pixels.
const SIDE_MAX: usize = 8192;
/// Greatest number of pixels of all textures that are read: six of 8K; they take seconds.
const PIXELS_MAX: usize = 400 << 20;
/// Greatest length of an encoded image, bytes.
const ENCODED_MAX_BYTES: usize = 128 << 20;
/// Greatest memory of a decoder beside its output, bytes.
const DECODER_MAX_BYTES: usize = 320 << 20;

/// A decoded texture.
pub(crate) struct Texture {
    width: usize,
    height: usize,
    /// Number of channels: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    channels: usize,
    pixels: Vec<u8>,
    wraps: [WrappingMode; 2],
}

/// Checks the sizes of textures of a document by their headers, before one is decoded.
///
/// # Errors
/// Where an image is missing, damaged, outside the folder or too large, or all together are too large.
pub(crate) fn check_sizes(
    document: &Document,
    path: &Path,
    outside: Outside,
    indices: impl Iterator<Item = usize>,
) -> Result<(), CharacterReason> {
    let mut count = 0;
    for index in indices {
        let Some(texture) = document.root.textures.get(index) else { continue };
        let image = texture.source.value();
        let Some(bytes) = image_bytes(document, path, outside, image)? else { continue };
        let [width, height] = match format(&bytes) {
            Some(Format::Png) => guarded(image, || png_header(image, &bytes).map(|(_, size)| size))?,
            Some(Format::Jpeg) => guarded(image, || jpeg_header(image, &bytes).map(|(_, size)| size))?,
            None => continue,
        };
        count += width * height;
    }
    match count <= PIXELS_MAX {
        true => Ok(()),
        false => Err(CharacterReason::TooLarge { count: count as u64, what: "pixels in textures", most: PIXELS_MAX }),
    }
}

/// The texture of a document by index; none where its format is not read.
///
/// # Errors
/// Where the image is missing, damaged, outside the folder or too large.
pub(crate) fn read(
    document: &Document,
    path: &Path,
    outside: Outside,
    index: usize,
) -> Result<Option<Texture>, CharacterReason> {
    let root = &document.root;
    let Some(texture) = root.textures.get(index) else { return Ok(None) };
    let image = texture.source.value();
    let Some(bytes) = image_bytes(document, path, outside, image)? else { return Ok(None) };
    let wrap = |mode: &Checked<WrappingMode>| match mode {
        Checked::Valid(mode) => *mode,
        Checked::Invalid => WrappingMode::Repeat,
    };
    let sampler = texture.sampler.and_then(|sampler| root.samplers.get(sampler.value()));
    let wraps = sampler.map_or([WrappingMode::Repeat; 2], |sampler| [wrap(&sampler.wrap_s), wrap(&sampler.wrap_t)]);
    match format(&bytes) {
        Some(Format::Png) => guarded(image, || png_texture(image, &bytes, wraps)).map(Some),
        Some(Format::Jpeg) => guarded(image, || jpeg_texture(image, &bytes, wraps)).map(Some),
        None => Ok(None),
    }
}

/// Format of an image.
enum Format {
    Png,
    Jpeg,
}

/// The format that an image begins with; none of those that are not read.
fn format(bytes: &[u8]) -> Option<Format> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some(Format::Png),
        [0xff, 0xd8, ..] => Some(Format::Jpeg),
        _ => None,
    }
}

/// Bytes of an image; none of one that the document does not have.
fn image_bytes(
    document: &Document,
    path: &Path,
    outside: Outside,
    index: usize,
) -> Result<Option<Vec<u8>>, CharacterReason> {
    let Some(image) = document.root.images.get(index) else { return Ok(None) };
    let position = format!("image {index}");
    if let Some(uri) = &image.uri {
        return Ok(Some(buffers::from_uri(path, &position, uri, ENCODED_MAX_BYTES, outside)?));
    }
    let Some(view) = image.buffer_view else { return Ok(None) };
    match document.view(view) {
        Some((bytes, _)) if bytes.len() <= ENCODED_MAX_BYTES => Ok(Some(bytes.to_vec())),
        _ => Err(damaged(index, "its bytes are missing or too many")),
    }
}

fn damaged(index: usize, problem: &str) -> CharacterReason {
    let problem: String = problem.chars().take(200).collect();
    let reason = RejectionReason::Malformed {
        position: format!("image {index}"),
        problem,
        remedy: "replace the texture, and export the file again",
    };
    CharacterReason::File(reason)
}

/// A decoder's result; an error where it panics.
fn guarded<T>(index: usize, decode: impl FnOnce() -> Result<T, CharacterReason>) -> Result<T, CharacterReason> {
    catch_panic::catch(decode).unwrap_or_else(|| Err(damaged(index, "it is damaged")))
}

fn check_size(index: usize, width: usize, height: usize) -> Result<(), CharacterReason> {
    match width.max(height) <= SIDE_MAX && width > 0 && height > 0 {
        true => Ok(()),
        false => Err(CharacterReason::LargeTexture { index, width, height, most: SIDE_MAX }),
    }
}

/// A decoder that has read the size of its image, and width and height.
type Header<Decoder> = Result<(Decoder, [usize; 2]), CharacterReason>;

fn png_header(index: usize, bytes: &[u8]) -> Header<png::Decoder<Cursor<&[u8]>>> {
    let limits = png::Limits { bytes: DECODER_MAX_BYTES };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    decoder.set_ignore_text_chunk(true);
    let (width, height) = decoder.read_header_info().map_err(|error| damaged(index, &error.to_string()))?.size();
    let (width, height) = (width as usize, height as usize);
    check_size(index, width, height)?;
    Ok((decoder, [width, height]))
}

fn png_texture(index: usize, bytes: &[u8], wraps: [WrappingMode; 2]) -> Result<Texture, CharacterReason> {
    let wrong = |error: png::DecodingError| damaged(index, &error.to_string());
    let (decoder, [width, height]) = png_header(index, bytes)?;
    let mut reader = decoder.read_info().map_err(wrong)?;
    let length = reader.output_buffer_size().filter(|length| *length <= 4 * SIDE_MAX * SIDE_MAX);
    let mut pixels = vec![0; length.ok_or_else(|| damaged(index, "it is too large"))?];
    reader.next_frame(&mut pixels).map_err(wrong)?;
    let channels = reader.output_color_type().0.samples();
    sized(index, Texture { width, height, channels, pixels, wraps })
}

fn jpeg_header(index: usize, bytes: &[u8]) -> Header<JpegDecoder<ZCursor<&[u8]>>> {
    // The decoder's own limits come one pixel above ours, which give the better message.
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(u16::MAX.into())
        .set_max_height(u16::MAX.into());
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| damaged(index, &error.to_string()))?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    check_size(index, width, height)?;
    Ok((decoder, [width, height]))
}

fn jpeg_texture(index: usize, bytes: &[u8], wraps: [WrappingMode; 2]) -> Result<Texture, CharacterReason> {
    let (mut decoder, [width, height]) = jpeg_header(index, bytes)?;
    let pixels = decoder.decode().map_err(|error| damaged(index, &error.to_string()))?;
    let channels = decoder.output_colorspace().map_or(3, |space| space.num_components());
    sized(index, Texture { width, height, channels, pixels, wraps })
}

/// A texture with as many pixels as its size states.
fn sized(index: usize, texture: Texture) -> Result<Texture, CharacterReason> {
    let Texture { width, height, channels, .. } = texture;
    match (1..=4).contains(&channels) && texture.pixels.len() >= width * height * channels {
        true => Ok(texture),
        false => Err(damaged(index, "it is cut short")),
    }
}

impl Texture {
    /// Linear colour and alpha at texture coordinates, between the four nearest pixels.
    pub(crate) fn colour(&self, uv: [f32; 2], linear: &[f32; 256]) -> [f32; 4] {
        let [across, down] = [(uv[0], self.width, self.wraps[0]), (uv[1], self.height, self.wraps[1])].map(taps);
        let mut colour = [0.0; 4];
        for (row, down_weight) in down {
            for (column, across_weight) in across {
                let pixel = self.pixel(column, row, linear);
                for (sum, part) in colour.iter_mut().zip(pixel) {
                    *sum += down_weight * across_weight * part;
                }
            }
        }
        colour.map(|part| part.clamp(0.0, 1.0))
    }

    fn pixel(&self, column: usize, row: usize, linear: &[f32; 256]) -> [f32; 4] {
        let start = (row * self.width + column) * self.channels;
        let [red, green, blue, alpha] = rgba(&self.pixels[start..start + self.channels]);
        let [red, green, blue] = [red, green, blue].map(|part| linear[usize::from(part)]);
        [red, green, blue, f32::from(alpha) / 255.0]
    }

    /// The texture as a character keeps it.
    pub(crate) fn kept(&self, linear: &[f32; 256]) -> CharacterTexture {
        let wrap = |mode: WrappingMode| match mode {
            WrappingMode::ClampToEdge => Wrap::Clamp,
            WrappingMode::MirroredRepeat => Wrap::Mirror,
            WrappingMode::Repeat => Wrap::Repeat,
        };
        let pixels = self.pixels.chunks_exact(self.channels).take(self.width * self.height).flat_map(rgba).collect();
        let size_px = [self.width as u32, self.height as u32];
        let mut kept = CharacterTexture { size_px, wraps: self.wraps.map(wrap), pixels };
        while kept.size_px.iter().any(|side| *side as usize > TEXTURE_SIDE_MAX) {
            kept = kept.halved(linear);
        }
        kept
    }
}

/// A pixel of one to four channels.
fn rgba(pixel: &[u8]) -> [u8; 4] {
    match *pixel {
        [grey] => [grey, grey, grey, 255],
        [grey, alpha] => [grey, grey, grey, alpha],
        [red, green, blue] => [red, green, blue, 255],
        [red, green, blue, alpha, ..] => [red, green, blue, alpha],
        [] => [0; 4],
    }
}

/// The two nearest pixels along one side, and their weights.
fn taps((coordinate, count, wrap): (f32, usize, WrappingMode)) -> [(usize, f32); 2] {
    let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
    let wrapped = match wrap {
        WrappingMode::ClampToEdge => coordinate.clamp(0.0, 1.0),
        WrappingMode::MirroredRepeat => {
            let turn = coordinate - 2.0 * (coordinate * 0.5).floor();
            if turn > 1.0 { 2.0 - turn } else { turn }
        }
        WrappingMode::Repeat => coordinate - coordinate.floor(),
    };
    let position = wrapped * count as f32 - 0.5;
    let (first, share) = (position.floor(), position - position.floor());
    let pixel = |index: f32| {
        let index = index as i64;
        match wrap {
            WrappingMode::Repeat => index.rem_euclid(count as i64) as usize,
            _ => index.clamp(0, count as i64 - 1) as usize,
        }
    };
    [(pixel(first), 1.0 - share), (pixel(first + 1.0), share)]
}

/// Name of an image in messages: its name, its file, or its number.
pub(crate) fn name(root: &Root, texture: usize) -> String {
    let image = root.textures.get(texture).map(|texture| texture.source.value());
    let found = image.and_then(|image| root.images.get(image));
    let named = found.and_then(|image| {
        let file = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
        image.name.as_deref().or(file).map(str::to_owned)
    });
    named.unwrap_or_else(|| format!("texture {texture}"))
}

//! A picture as PNG: eight bits, sRGB, fast compression.

use std::path::Path;

use motiondb::files::atomic_file;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};
use tiny_skia::Pixmap;

use crate::error::RenderError;

/// Writes an opaque picture, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, pixmap: &Pixmap) -> Result<(), RenderError> {
    let written = encode(pixmap).map_err(Into::into).and_then(|bytes| atomic_file::write(path, &bytes));
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Bytes of the file, without an alpha channel.
fn encode(pixmap: &Pixmap) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let pixels: Vec<[u8; 3]> =
        pixmap.data().as_chunks().0.iter().map(|&[red, green, blue, _]| [red, green, blue]).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    writer.finish()?;
    Ok(bytes)
}

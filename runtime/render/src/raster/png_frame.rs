//! A picture as PNG: eight bits, sRGB, fast compression.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use motiondb::files::atomic_file::AtomicFile;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::error::RenderError;
use crate::raster::strips::PictureStrips;

/// Writes an opaque picture, complete or not at all.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, pixmap: &Pixmap) -> Result<(), RenderError> {
    write_strips(path, &mut &*pixmap)
}

/// As [`write`], of a picture that is drawn strip by strip.
pub(crate) fn write_strips(path: &Path, picture: &mut impl PictureStrips) -> Result<(), RenderError> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        encode(file.writer(), picture)?;
        file.commit()
    });
    written.map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Encodes a picture without an alpha channel. The crate compresses all rows at once: only its streaming writer, which
/// gives other bytes, takes them one by one.
fn encode(out: &mut impl Write, picture: &mut impl PictureStrips) -> io::Result<()> {
    let [width, height] = picture.size_px();
    let rows = rgb_rows(picture)?;
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rows.as_flattened())?;
    Ok(writer.finish()?)
}

/// A picture as rows of red, green and blue, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbPicture {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Pixels, row by row.
    pub pixels: Vec<[u8; 3]>,
}

/// A picture that is drawn strip by strip, as rows.
///
/// # Errors
/// If the system gives too little memory.
pub(crate) fn rgb_picture(picture: &mut impl PictureStrips) -> Result<RgbPicture, RenderError> {
    let size_px = picture.size_px();
    let mib = (3 * size_px[0] as usize * size_px[1] as usize) >> 20;
    let pixels = rgb_rows(picture).map_err(|_| RenderError::OutOfMemory { mib })?;
    Ok(RgbPicture { size_px, pixels })
}

/// Red, green and blue of all pixels.
fn rgb_rows(picture: &mut impl PictureStrips) -> io::Result<Vec<[u8; 3]>> {
    let [width, height] = picture.size_px().map(|side| side as usize);
    let mut rows = Vec::new();
    rows.try_reserve_exact(width * height).map_err(|_| io::Error::from(ErrorKind::OutOfMemory))?;
    for top_px in (0..height as u32).step_by(picture.strip_rows() as usize) {
        picture.draw(top_px);
        let left = width * height - rows.len();
        let shown = picture.pixels().iter().take(left);
        rows.extend(shown.map(|pixel: &PremultipliedColorU8| [pixel.red(), pixel.green(), pixel.blue()]));
    }
    Ok(rows)
}

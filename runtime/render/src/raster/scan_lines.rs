//! Writes an EXR file strip by strip, so that a large frame takes little memory; blocks of a strip are compressed in
//! parallel. The bytes depend on the picture alone.
//!
//! The `exr` crate stores attributes without a named field in a hash map, whose order changes from run to run: where
//! there are any, the header is written a second time, sorted.

use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::ops::Range;

use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::Headers;
use rayon::prelude::*;

use crate::raster::exr_header::sort_attributes;

/// Number of lines by which strips begin: blocks of every compression end there.
pub(crate) const STRIP_STEP: usize = 32;

/// Writes a file of one part. `draw` gives each strip of at most `strip_lines` lines in turn, and `line` appends the
/// bytes of one of its lines, channel by channel.
///
/// # Errors
/// If the file cannot be written, or a strip cannot be drawn.
pub(crate) fn write<S: Sync>(
    out: &mut (impl Write + Seek),
    headers: Headers,
    strip_lines: usize,
    mut draw: impl FnMut(Range<usize>) -> io::Result<S>,
    line: impl Fn(&S, usize, &mut Vec<u8>) + Sync,
) -> io::Result<()> {
    let is_sorted = headers[0].own_attributes.other.is_empty();
    let sorted = if is_sorted { Vec::new() } else { sorted_header(headers.clone()) };
    let strip_lines = strip_lines.next_multiple_of(STRIP_STEP).max(STRIP_STEP);
    let mut fault = None;
    let written = exr::block::write(&mut *out, headers, true, |meta, chunks| {
        let blocks: Vec<(usize, BlockIndex)> = meta.enumerate_ordered_header_block_indices().collect();
        let height = meta.headers[0].layer_size.height();
        for strip in
            blocks.chunk_by(|(_, a), (_, b)| a.pixel_position.y() / strip_lines == b.pixel_position.y() / strip_lines)
        {
            let top = strip[0].1.pixel_position.y();
            let drawn = match draw(top..(top + strip_lines).min(height)) {
                Ok(drawn) => drawn,
                Err(error) => {
                    fault = Some(error);
                    return Err(exr::error::Error::Aborted);
                }
            };
            let compress = |&(index, block): &(usize, BlockIndex)| {
                let mut data = Vec::with_capacity(block.pixel_size.area() * meta.headers[0].channels.bytes_per_pixel);
                let lines = block.pixel_position.y()..block.pixel_position.y() + block.pixel_size.height();
                lines.for_each(|y| line(&drawn, y, &mut data));
                Ok((index, UncompressedBlock { index: block, data }.compress_to_chunk(&meta.headers)?))
            };
            let compressed = strip.par_iter().map(compress).collect::<exr::error::Result<Vec<_>>>()?;
            for (index, chunk) in compressed {
                chunks.write_chunk(index, chunk)?;
            }
        }
        Ok(())
    });
    if let Some(fault) = fault {
        return Err(fault);
    }
    written.map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    })?;
    if !sorted.is_empty() {
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&sorted)?;
    }
    Ok(())
}

/// The bytes of a header with its attributes in order.
fn sorted_header(headers: Headers) -> Vec<u8> {
    let mut header = Cursor::new(Vec::new());
    // A file without blocks is refused in the end, but its header is written by then.
    let _ = exr::block::write(&mut header, headers, true, |_, _| Ok(()));
    let mut bytes = header.into_inner();
    let end = sort_attributes(&mut bytes);
    bytes.truncate(end);
    bytes
}

//! Compression of one frame: zlib over the packed agents, transposed.
//!
//! Transposed, the bytes of equal meaning of neighbouring agents stand side by side, which makes the result a twelfth
//! smaller.

use std::io::{self, Read, Write};

use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use crate::recording::frame_packing::PACKED_BYTES;

/// The compressed bytes of packed agents; the encoder is kept from frame to frame.
pub(crate) fn compress(zlib: &mut ZlibEncoder<Vec<u8>>, packed: &[u8]) -> io::Result<Vec<u8>> {
    zlib.write_all(&transpose(packed, PACKED_BYTES))?;
    zlib.reset(Vec::new())
}

/// The inverse of [`compress`]; none unless exactly `agent_count` agents result.
pub(crate) fn decompress(payload: &[u8], agent_count: usize) -> Option<Vec<u8>> {
    let length = agent_count * PACKED_BYTES;
    let mut planes = Vec::with_capacity(length);
    // One byte more than expected, to detect a payload that is too long.
    ZlibDecoder::new(payload).take(length as u64 + 1).read_to_end(&mut planes).ok()?;
    (planes.len() == length).then(|| transpose(&planes, agent_count))
}

/// Rows of `columns` bytes become columns.
fn transpose(bytes: &[u8], columns: usize) -> Vec<u8> {
    let rows = bytes.len() / columns;
    let mut transposed = vec![0; bytes.len()];
    for (row, values) in bytes.chunks_exact(columns).enumerate() {
        for (column, value) in values.iter().enumerate() {
            transposed[column * rows + row] = *value;
        }
    }
    transposed
}

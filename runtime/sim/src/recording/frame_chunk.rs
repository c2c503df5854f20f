//! The payload of a frame's chunk: its number and its number of agents, u32 each, then zlib over the agents' rows,
//! transposed.
//!
//! A row of 206 bytes, little-endian: the agent's id less the id before it less 1, u32 (the first row: the id); the index
//! of its behaviour state, u16; the 200 bytes of `frame_packing`. Of a crowd without gaps all ids are 0 so, which zlib
//! reduces to nothing. Transposed, the bytes of equal meaning of neighbouring agents stand side by side, which makes the
//! result a twelfth smaller. Version 1 has neither number, ids nor states, and rows of 200 bytes.
//!
//! The chunk of a frame's extra joints has the same form; a row holds 6 bytes for each joint (`rotation_packing`).

use std::io::{self, Read, Write};

use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use glam::{Quat, Vec2};

use crate::population::AgentId;
use crate::recording::frame::AgentFrame;
use crate::recording::frame_packing::{FrameFault, PACKED_BYTES, SCALAR_MAX, pack};
use crate::recording::rotation_packing::{COARSE_BITS, pack_rotation, packed_rotation_bytes, unpack_rotation};
use crate::scenario::ranges::AGENTS_MAX;

/// Bytes of a row before its packed agent.
const KEY_BYTES: usize = 6;
/// Bytes of an agent's position, the first ones of its packed frame.
const POSITION_BYTES: usize = 8;
/// Bytes of a row.
pub(crate) const ROW_BYTES: usize = KEY_BYTES + PACKED_BYTES;
/// Bytes of an extra joint.
pub(crate) const EXTRA_JOINT_BYTES: usize = packed_rotation_bytes(COARSE_BITS);
/// Greatest length of data, relative to its compressed bytes: the limit of deflate.
const DEFLATE_RATIO_MAX: usize = 1_032;

/// The start of a frame's payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrameStart {
    /// Index of the frame.
    pub(crate) number: u32,
    /// Number of agents.
    pub(crate) agent_count: usize,
}

/// Appends the row of an agent; `before` is the id of the row before it. None where a value is not finite, or beyond all
/// scenarios, or the ids do not rise.
pub(crate) fn append_row(agent: &AgentFrame, before: Option<AgentId>, rows: &mut Vec<u8>) -> Option<()> {
    let gap = agent.id.0.checked_sub(before.map_or(0, |before| before.0.saturating_add(1)))?;
    rows.extend(gap.to_le_bytes());
    rows.extend(agent.state.to_le_bytes());
    pack(agent, rows)
}

/// Appends the row of an agent's extra joints. None where a rotation is not finite.
pub(crate) fn append_extra_row(rotations: &[Quat], rows: &mut Vec<u8>) -> Option<()> {
    for rotation in rotations {
        let packed = rotation.is_finite().then(|| pack_rotation(*rotation, COARSE_BITS))?;
        rows.extend(&packed.to_le_bytes()[..EXTRA_JOINT_BYTES]);
    }
    Some(())
}

/// The rotations of extra joints in any number of rows: the inverse of [`append_extra_row`].
pub(crate) fn read_extra_rows(rows: &[u8]) -> impl Iterator<Item = Quat> {
    rows.chunks_exact(EXTRA_JOINT_BYTES).map(|packed| {
        let mut wide = [0; 8];
        wide[..packed.len()].copy_from_slice(packed);
        unpack_rotation(u64::from_le_bytes(wide), COARSE_BITS)
    })
}

/// The payload of a frame with these rows of `row_bytes` bytes; the encoder is kept from frame to frame.
pub(crate) fn compress(
    number: u32,
    zlib: &mut ZlibEncoder<Vec<u8>>,
    rows: &[u8],
    row_bytes: usize,
) -> io::Result<Vec<u8>> {
    zlib.get_mut().extend(number.to_le_bytes());
    zlib.get_mut().extend(((rows.len() / row_bytes) as u32).to_le_bytes());
    zlib.write_all(&transpose(rows, row_bytes))?;
    zlib.reset(Vec::new())
}

/// The start of a frame's payload, and the compressed rows of `row_bytes` bytes; none where it has fewer bytes than its
/// agents need.
pub(crate) fn start(payload: &[u8], row_bytes: usize) -> Option<(FrameStart, &[u8])> {
    let (number, rest) = payload.split_first_chunk::<4>()?;
    let (count, compressed) = rest.split_first_chunk::<4>()?;
    let agent_count = u32::from_le_bytes(*count) as usize;
    let has_room = agent_count <= AGENTS_MAX && agent_count * row_bytes / DEFLATE_RATIO_MAX <= compressed.len();
    has_room.then_some((FrameStart { number: u32::from_le_bytes(*number), agent_count }, compressed))
}

/// The rows of `row_bytes` bytes that were compressed; none unless exactly `count` result.
pub(crate) fn decompress(compressed: &[u8], row_bytes: usize, count: usize) -> Option<Vec<u8>> {
    let length = count * row_bytes;
    let mut planes = Vec::with_capacity(length);
    // One byte more than expected, to detect a payload that is too long.
    ZlibDecoder::new(compressed).take(length as u64 + 1).read_to_end(&mut planes).ok()?;
    (planes.len() == length).then(|| transpose(&planes, count))
}

/// Ids and positions of `count` agents in compressed rows. Transposed, they are the first bytes: only these are
/// decompressed. None where there are too few bytes, or a value is beyond all scenarios.
pub(crate) fn read_positions(compressed: &[u8], count: usize) -> Option<Vec<(AgentId, Vec2)>> {
    let mut planes = vec![0; count * (KEY_BYTES + POSITION_BYTES)];
    ZlibDecoder::new(compressed).read_exact(&mut planes).ok()?;
    let (mut agents, mut least) = (Vec::with_capacity(count), 0_u32);
    for agent in 0..count {
        let word = |plane: usize| [0, 1, 2, 3].map(|byte| planes[(plane + byte) * count + agent]);
        let id = least.checked_add(u32::from_le_bytes(word(0)))?;
        let position_m = Vec2::from([0, 4].map(|byte| f32::from_le_bytes(word(KEY_BYTES + byte))));
        (position_m.abs().max_element() <= SCALAR_MAX && position_m.is_finite()).then_some(())?;
        least = id.saturating_add(1);
        agents.push((AgentId(id), position_m));
    }
    Some(agents)
}

/// The inverse of [`append_row`], given how the format version unpacks an agent.
///
/// # Errors
/// What is wrong with the row.
pub(crate) fn read_row(
    row: &[u8],
    before: Option<AgentId>,
    unpack: impl Fn(&[u8]) -> Result<AgentFrame, FrameFault>,
) -> Result<AgentFrame, FrameFault> {
    let (key, packed) = row.split_first_chunk::<KEY_BYTES>().ok_or(FrameFault::TooShort)?;
    let gap = u32::from_le_bytes([key[0], key[1], key[2], key[3]]);
    let least = before.map_or(Some(0), |before| before.0.checked_add(1)).ok_or(FrameFault::IdOutOfRange)?;
    let id = AgentId(least.checked_add(gap).ok_or(FrameFault::IdOutOfRange)?);
    Ok(AgentFrame { id, state: u16::from_le_bytes([key[4], key[5]]), ..unpack(packed)? })
}

/// Rows of `columns` bytes become columns.
fn transpose(bytes: &[u8], columns: usize) -> Vec<u8> {
    if columns == 0 {
        return Vec::new();
    }
    let rows = bytes.len() / columns;
    let mut transposed = vec![0; bytes.len()];
    for (row, values) in bytes.chunks_exact(columns).enumerate() {
        for (column, value) in values.iter().enumerate() {
            transposed[column * rows + row] = *value;
        }
    }
    transposed
}

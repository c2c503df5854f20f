//! Magic number, version and chunk kinds of `.fbrec`; docs/fbrec.md describes the format.

/// Format version that is written; raised when a reader of the old version would misread the new one.
pub const FORMAT_VERSION: u32 = 3;
/// The format version before, which is still read: agents want to face where their preferred velocities lead.
pub(crate) const FORMAT_VERSION_2: u32 = 2;
/// The first format version, which is still read: the same agents in all frames.
pub const FORMAT_VERSION_1: u32 = 1;
/// First bytes of every recording.
pub(crate) const MAGIC: [u8; 8] = *b"FBREC\r\n\x1a";
/// Byte at which the `HEAD` chunk begins: after magic and version.
pub(crate) const HEAD_BYTE: u64 = 12;

/// Kind of a chunk; readers skip kinds that they do not know.
pub type ChunkKind = [u8; 4];
/// Bytes of a chunk before its payload.
pub const CHUNK_HEAD_BYTES: u64 = 12;
/// Bytes of the `TAIL` chunk.
pub(crate) const TAIL_BYTES: u64 = CHUNK_HEAD_BYTES + 8;
/// Bytes of an entry of the index: kind of a chunk, and the byte at which it begins.
pub(crate) const INDEX_ENTRY_BYTES: usize = 12;

/// Chunk of the header.
pub(crate) const HEAD: ChunkKind = *b"HEAD";
/// Chunk of one frame.
pub(crate) const FRAME: ChunkKind = *b"FRAM";
/// Chunk of the extra joints in one frame.
pub(crate) const EXTRA: ChunkKind = *b"EXTR";
/// Chunk of all agents.
pub(crate) const AGENTS: ChunkKind = *b"AGNT";
/// Chunk of the index.
pub(crate) const INDEX: ChunkKind = *b"INDX";
/// Chunk that ends the file.
pub(crate) const TAIL: ChunkKind = *b"TAIL";

//! Magic number, version and chunk kinds of `.fbrec`.

/// Format version; raised when a reader of the old version would misread the new one.
pub const FORMAT_VERSION: u32 = 2;
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

/// Chunk of the header.
pub(crate) const HEAD: ChunkKind = *b"HEAD";
/// Chunk of one frame.
pub(crate) const FRAME: ChunkKind = *b"FRAM";
/// Chunk of the index.
pub(crate) const INDEX: ChunkKind = *b"INDX";
/// Chunk that ends the file.
pub(crate) const TAIL: ChunkKind = *b"TAIL";

//! A recording's chunks: {kind u32, payload length u32, CRC-32 of kind, length and payload, payload}, little-endian.
//!
//! Every length that a chunk claims is checked against the size of the file before anything is allocated.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use motiondb::files::input_file;

use crate::recording::error::RecordingError;
use crate::recording::format::{CHUNK_HEAD_BYTES, ChunkKind};

/// Writes one chunk.
///
/// # Errors
/// If writing fails or the payload reaches 4 GiB.
pub fn write_chunk(out: &mut impl Write, kind: ChunkKind, payload: &[u8]) -> io::Result<()> {
    let length = u32::try_from(payload.len()).map_err(|_| io::Error::other("a chunk of 4 GiB or more"))?;
    out.write_all(&kind)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&checksum(kind, length, payload).to_le_bytes())?;
    out.write_all(payload)
}

fn checksum(kind: ChunkKind, length: u32, payload: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&kind);
    hasher.update(&length.to_le_bytes());
    hasher.update(payload);
    hasher.finalize()
}

/// A file of chunks, read at any byte from any thread.
#[derive(Debug)]
pub(crate) struct ChunkFile {
    path: PathBuf,
    length: u64,
    /// Seeking and reading are one step under the lock; decoding, the expensive part, is outside.
    file: Mutex<File>,
}

impl ChunkFile {
    /// Opens a file.
    ///
    /// # Errors
    /// If the system cannot open it.
    pub(crate) fn open(path: &Path) -> Result<Self, RecordingError> {
        let fail = |source| RecordingError::Unreadable { path: path.to_owned(), source };
        let file = input_file::open(path).map_err(fail)?;
        let length = file.metadata().map_err(fail)?.len();
        Ok(Self { path: path.to_owned(), length, file: Mutex::new(file) })
    }

    /// Path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Length of the file, bytes.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// Exactly `count` bytes from `byte` on.
    ///
    /// # Errors
    /// If the file ends before them or the system cannot read it.
    pub(crate) fn read(&self, byte: u64, count: u64) -> Result<Vec<u8>, RecordingError> {
        if byte.checked_add(count).is_none_or(|end| end > self.length) {
            return Err(self.damaged(byte, format!("{count} bytes are missing")));
        }
        let mut bytes = Vec::new();
        let length = usize::try_from(count).map_err(|_| self.damaged(byte, "too long for this machine"))?;
        bytes.try_reserve_exact(length).map_err(|_| self.out_of_memory())?;
        bytes.resize(length, 0);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(byte))
            .and_then(|_| file.read_exact(&mut bytes))
            .map_err(|source| RecordingError::Unreadable { path: self.path.clone(), source })?;
        Ok(bytes)
    }

    /// The payload of the chunk at `byte`, which must be of a kind and have at most `most` bytes.
    ///
    /// # Errors
    /// As [`Self::read`]; if the kind is another, the payload is longer or the checksum is wrong.
    pub(crate) fn read_chunk(&self, byte: u64, kind: ChunkKind, most: u64) -> Result<Vec<u8>, RecordingError> {
        let head = self.read(byte, CHUNK_HEAD_BYTES)?;
        let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        if head[..4] != kind {
            return Err(self.damaged(byte, format!("there is no {} chunk here", kind.escape_ascii())));
        }
        let is_present = byte + CHUNK_HEAD_BYTES + u64::from(word(4)) <= self.length;
        if u64::from(word(4)) > most && is_present {
            let what = format!("the {} chunk has more than {most} bytes", kind.escape_ascii());
            return Err(self.damaged(byte, what));
        }
        let payload = self.read(byte + CHUNK_HEAD_BYTES, u64::from(word(4)))?;
        if checksum(kind, word(4), &payload) != word(8) {
            return Err(self.damaged(byte, format!("the checksum of the {} chunk is wrong", kind.escape_ascii())));
        }
        Ok(payload)
    }

    /// The error that the system has too little memory for the file.
    pub(crate) fn out_of_memory(&self) -> RecordingError {
        RecordingError::Unreadable { path: self.path.clone(), source: ErrorKind::OutOfMemory.into() }
    }

    /// The error that the file is damaged at a byte.
    pub(crate) fn damaged(&self, byte: u64, what: impl Into<String>) -> RecordingError {
        RecordingError::Damaged { path: self.path.clone(), byte, what: what.into() }
    }
}

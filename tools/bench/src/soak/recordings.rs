//! Recordings: mutated anywhere, or altered within a chunk that gets a right checksum. A recording that opens is
//! measured.

use std::fs;
use std::mem;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::measures::measure;
use fbcrowd_sim::recording::{
    CHUNK_HEAD_BYTES, ChunkKind, Header, Recorder, Recording, RecordingError, unzip_text, write_chunk, zip_text,
};
use fbcrowd_sim::simulation::Simulation;
use motiondb::motion::MotionDb;

use crate::error::BenchError;
use crate::soak::databases::crossing;
use crate::soak::draw::Draw;
use crate::soak::mutation::mutated;
use crate::soak::scratch::Scratch;
use crate::soak::tally::CopyOutcome;

/// Length of magic and version, before the first chunk, bytes.
const HEAD_BYTES: usize = 12;
/// Frames of the recording.
const FRAMES: usize = 8;

/// The bytes of a valid recording.
pub(crate) fn bytes(db: &Arc<MotionDb>, scratch: &Scratch) -> Result<Vec<u8>, BenchError> {
    let path = scratch.path().join("valid.fbrec");
    record(db, &path)?;
    fs::read(&path).map_err(|error| BenchError::unreadable(&path, error))
}

/// Records a few frames.
fn record(db: &Arc<MotionDb>, path: &Path) -> Result<(), RecordingError> {
    let header = Header::new(db, 0, crossing());
    let mut simulation = Simulation::new(Arc::clone(db), &header.scenario);
    let mut recorder = Recorder::create(path, &header)?;
    for _ in 0..FRAMES {
        recorder.push(simulation.frames())?;
        simulation.step(&mut |_| ());
    }
    recorder.finish(simulation.population())
}

/// Mutates a recording and measures it.
pub(crate) fn read(recording: &[u8], scratch: &Scratch, draw: &mut Draw) -> CopyOutcome {
    let copy = if draw.flip() { mutated(recording, &draw.edits(recording.len())) } else { forged(recording, draw) };
    let measured = scratch.with(draw, &copy, |path| measure(&Recording::open(path)?));
    measured.map_or(CopyOutcome::Rejected, |_| CopyOutcome::Used)
}

/// Alters one chunk, that of zipped JSON in its text, and gives it a right checksum; the index names the new bytes.
fn forged(recording: &[u8], draw: &mut Draw) -> Vec<u8> {
    let chunks = chunks(&recording[HEAD_BYTES..]);
    let chosen = draw.below(chunks.len());
    let (mut file, mut index) = (recording[..HEAD_BYTES].to_vec(), Vec::new());
    let mut index_byte = 0;
    for (number, (kind, payload)) in chunks.into_iter().enumerate() {
        let byte = file.len() as u64;
        let mut content = match &kind {
            b"HEAD" | b"AGNT" => unzip_text(payload).expect("the recording is valid"),
            b"INDX" => mem::take(&mut index),
            b"TAIL" => u64::to_le_bytes(index_byte).to_vec(),
            _ => payload.to_vec(),
        };
        if number == chosen {
            alter(kind, &mut content, draw);
        }
        match &kind {
            b"HEAD" => content = zip_text(&content).expect("memory takes a short text"),
            b"AGNT" => {
                content = zip_text(&content).expect("memory takes a short text");
                append_entry(&mut index, kind, byte);
            }
            b"FRAM" => append_entry(&mut index, kind, byte),
            b"INDX" => index_byte = byte,
            _ => {}
        }
        write_chunk(&mut file, kind, &content).expect("memory takes a short payload");
    }
    file
}

/// Replaces numbers of a text, or alters bytes.
fn alter(kind: ChunkKind, content: &mut Vec<u8>, draw: &mut Draw) {
    for edit in draw.edits(content.len().max(1)) {
        if matches!(&kind, b"HEAD" | b"AGNT") { edit.replace_number(content) } else { edit.alter(content) }
    }
}

fn append_entry(index: &mut Vec<u8>, kind: ChunkKind, byte: u64) {
    index.extend(kind);
    index.extend(byte.to_le_bytes());
}

/// Types and payloads of the chunks of a valid recording.
fn chunks(mut rest: &[u8]) -> Vec<(ChunkKind, &[u8])> {
    let mut chunks = Vec::new();
    while let Some((head, after)) = rest.split_first_chunk::<{ CHUNK_HEAD_BYTES as usize }>() {
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let (payload, after) = after.split_at(length);
        chunks.push(([head[0], head[1], head[2], head[3]], payload));
        rest = after;
    }
    chunks
}

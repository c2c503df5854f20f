//! Recordings: mutated anywhere, or altered within a chunk that gets a right checksum. A recording that opens is
//! measured.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::measures::measure;
use fbcrowd_sim::recording::{CHUNK_HEAD_BYTES, ChunkKind, Header, Recorder, Recording, RecordingError, write_chunk};
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

/// Alters the payload of one chunk and gives it a right checksum.
fn forged(recording: &[u8], draw: &mut Draw) -> Vec<u8> {
    let chunks = chunks(&recording[HEAD_BYTES..]);
    let chosen = draw.below(chunks.len());
    let mut file = recording[..HEAD_BYTES].to_vec();
    for (index, (kind, payload)) in chunks.into_iter().enumerate() {
        let mut payload = payload.to_vec();
        if index == chosen {
            draw.edits(payload.len().max(1)).into_iter().for_each(|edit| edit.alter(&mut payload));
        }
        write_chunk(&mut file, kind, &payload).expect("memory takes a payload as short as it was");
    }
    file
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

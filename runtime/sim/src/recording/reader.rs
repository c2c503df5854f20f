//! The reader of a recording: header and index on opening, frames on demand.

use std::path::Path;

use crate::recording::chunk::ChunkFile;
use crate::recording::compression::decompress;
use crate::recording::error::RecordingError;
use crate::recording::format::{FORMAT_VERSION, FRAME, INDEX, MAGIC, TAIL, TAIL_BYTES};
use crate::recording::frame::AgentFrame;
use crate::recording::frame_packing::{PACKED_BYTES, unpack};
use crate::recording::header::Header;

/// Greatest length of an index, bytes: that of a day in steps of a millisecond.
const INDEX_LIMIT_BYTES: u64 = 8 * 86_400_001;

/// An open recording; frames are read on demand, from any thread.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_sim::Recording;
/// use motiondb::body::Joint;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let recording = Recording::open(Path::new("antipodal.fbrec"))?;
/// let mut agents = Vec::new();
/// recording.read_frame(0, &mut agents)?;
/// for agent in &agents {
///     let joints = agent.pose.forward_kinematics(&recording.header().skeleton);
///     // From the root's frame to the world, metres.
///     println!("{}", agent.root.to_world(joints.positions_m[Joint::Head.index()]));
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Recording {
    file: ChunkFile,
    header: Header,
    /// Byte at which each frame's chunk begins.
    frame_bytes: Vec<u64>,
}

impl Recording {
    /// Reads header and index, and checks them; each frame is checked when it is read.
    ///
    /// # Errors
    /// If the file is not a recording, of another version, cut short or altered.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = ChunkFile::open(path)?;
        check_magic(&file)?;
        let header = Header::decode(&file)?;
        let frame_bytes = read_index(&file)?;
        Ok(Self { file, header, frame_bytes })
    }

    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Number of frames, the start included: steps + 1, so at least one.
    pub fn frame_count(&self) -> usize {
        self.frame_bytes.len()
    }

    /// Replaces `agents` by those of one frame, in index order.
    ///
    /// # Errors
    /// If there is no such frame or its bytes are altered.
    pub fn read_frame(&self, index: usize, agents: &mut Vec<AgentFrame>) -> Result<(), RecordingError> {
        let path = || self.file.path().to_owned();
        let count = self.frame_count();
        let no_such_frame = || RecordingError::NoSuchFrame { path: path(), index, count };
        let byte = *self.frame_bytes.get(index).ok_or_else(no_such_frame)?;
        let agent_count = self.header.scenario.agents.len();
        let payload = self.file.read_chunk(byte, FRAME, most_frame_bytes(agent_count))?;
        let packed = decompress(&payload, agent_count)
            .ok_or_else(|| self.file.damaged(byte, "the frame does not hold the scenario's agents"))?;
        agents.clear();
        agents.try_reserve(agent_count).map_err(|_| self.file.out_of_memory())?;
        for (agent, bytes) in packed.chunks_exact(PACKED_BYTES).enumerate() {
            let at_agent = |fault| RecordingError::Frame { path: path(), frame: index, agent, fault };
            agents.push(unpack(bytes).map_err(at_agent)?);
        }
        Ok(())
    }
}

/// Greatest length of a frame's payload: zlib makes nothing that is hard to compress much longer.
fn most_frame_bytes(agent_count: usize) -> u64 {
    (2 * agent_count * PACKED_BYTES) as u64 + 1024
}

fn check_magic(file: &ChunkFile) -> Result<(), RecordingError> {
    let foreign = || RecordingError::Foreign { path: file.path().to_owned() };
    if file.length() < MAGIC.len() as u64 || file.read(0, MAGIC.len() as u64)? != MAGIC {
        return Err(foreign());
    }
    let version = file.read(MAGIC.len() as u64, 4)?;
    let found = u32::from_le_bytes(version.try_into().map_err(|_| foreign())?);
    if found == FORMAT_VERSION { Ok(()) } else { Err(RecordingError::Version { path: file.path().to_owned(), found }) }
}

/// The byte at which each frame's chunk begins.
fn read_index(file: &ChunkFile) -> Result<Vec<u64>, RecordingError> {
    let tail_byte = file.length().saturating_sub(TAIL_BYTES);
    let index_byte = match file.read_chunk(tail_byte, TAIL, TAIL_BYTES)?.try_into() {
        Ok(bytes) => u64::from_le_bytes(bytes),
        Err(_) => return Err(file.damaged(tail_byte, "the last chunk names no index")),
    };
    let index = file.read_chunk(index_byte, INDEX, INDEX_LIMIT_BYTES)?;
    let (bytes @ [_, ..], []) = index.as_chunks::<8>() else {
        return Err(file.damaged(index_byte, "the index is empty or not whole"));
    };
    let frame_bytes: Vec<u64> = bytes.iter().map(|byte| u64::from_le_bytes(*byte)).collect();
    // So that a short file cannot claim many frames.
    if !frame_bytes.is_sorted_by(|a, b| a < b) {
        return Err(file.damaged(index_byte, "the index does not rise"));
    }
    Ok(frame_bytes)
}

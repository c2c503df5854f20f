//! The reader of a recording: header, agents and index on opening, frames on demand.

use std::path::Path;

use glam::{Quat, Vec2};

use crate::population::{AgentId, Population};
use crate::recording::chunk::ChunkFile;
use crate::recording::error::RecordingError;
use crate::recording::format::{
    AGENTS, EXTRA, FORMAT_VERSION, FORMAT_VERSION_1, FORMAT_VERSION_2, FRAME, INDEX, INDEX_ENTRY_BYTES, MAGIC, TAIL,
    TAIL_BYTES,
};
use crate::recording::frame::AgentFrame;
use crate::recording::frame_chunk::{EXTRA_JOINT_BYTES, FrameStart, ROW_BYTES, decompress, read_extra_rows};
use crate::recording::frame_packing::{PACKED_BYTES, unpack, unpack_version_2};
use crate::recording::header::Header;
use crate::recording::{agents_chunk, frame_chunk, version_1, zipped_json};

/// Greatest length of an index, bytes: that of a day in steps of a millisecond, with extra joints.
pub(crate) const INDEX_LIMIT_BYTES: u64 = INDEX_ENTRY_BYTES as u64 * (2 * 86_400_001 + 1);

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
///     let joints = agent.pose.forward_kinematics(recording.header().skeleton());
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
    population: Population,
    frames: FrameIndex,
}

/// Where the frames of a file are.
#[derive(Debug)]
struct FrameIndex {
    /// Format version of the file.
    version: u32,
    /// Byte at which each frame's chunk begins.
    bytes: Vec<u64>,
    /// Byte at which the chunk of each frame's extra joints begins; empty where the header lists none.
    extra_bytes: Vec<u64>,
    /// Number of agents in each frame.
    agent_counts: Vec<u32>,
}

impl Recording {
    /// Reads header, index and agents, and checks them; each frame is checked when it is read.
    ///
    /// # Errors
    /// If the file is not a recording, of an unknown version, cut short or altered.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = ChunkFile::open(path)?;
        let version = read_version(&file)?;
        let (header, population, [bytes, extra_bytes]) = if version == FORMAT_VERSION_1 {
            let header = version_1::read_header(&file)?;
            let bytes = version_1::read_index(&file, index_byte(&file)?)?;
            let population = Population::of(&header.scenario);
            (header, population, [bytes, Vec::new()])
        } else {
            let header = Header::read(&file)?;
            let (frame_bytes, agents_byte) = read_index(&file, !header.extra_joints.is_empty())?;
            let population = read_population(&file, &header, agents_byte, frame_bytes[0].len())?;
            (header, population, frame_bytes)
        };
        let agent_counts = agent_counts(&population, bytes.len());
        Ok(Self { file, header, population, frames: FrameIndex { version, bytes, extra_bytes, agent_counts } })
    }

    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// All agents, from birth to removal, and the counts of the sources.
    pub fn population(&self) -> &Population {
        &self.population
    }

    /// Number of frames, the start included: steps + 1, so at least one.
    pub fn frame_count(&self) -> usize {
        self.frames.bytes.len()
    }

    /// Number of agents in a frame; 0 of a frame that there is not.
    pub fn agent_count(&self, frame: usize) -> usize {
        self.frames.agent_counts.get(frame).map_or(0, |count| *count as usize)
    }

    /// Replaces `agents` by those of one frame, in the order of ids.
    ///
    /// # Errors
    /// If there is no such frame or its bytes are altered.
    pub fn read_frame(&self, index: usize, agents: &mut Vec<AgentFrame>) -> Result<(), RecordingError> {
        let path = || self.file.path().to_owned();
        let byte = *self.frames.bytes.get(index).ok_or_else(|| self.no_such_frame(index))?;
        let expected = self.agent_count(index);
        let payload = self.file.read_chunk(byte, FRAME, most_frame_bytes(expected, ROW_BYTES))?;
        agents.clear();
        agents.try_reserve(expected).map_err(|_| self.file.out_of_memory())?;
        if self.frames.version == FORMAT_VERSION_1 {
            return self.read_frame_of_version_1(index, byte, &payload, agents);
        }
        let rows = self.rows(index, byte, &payload, ROW_BYTES)?;
        let unpack = match self.frames.version {
            FORMAT_VERSION_2 => unpack_version_2,
            _ => unpack,
        };
        for row in rows.chunks_exact(ROW_BYTES) {
            let agent = agents.len();
            let at_agent = |fault| RecordingError::Frame { path: path(), byte, frame: index, agent, fault };
            let frame = frame_chunk::read_row(row, agents.last().map(|before: &AgentFrame| before.id), unpack);
            agents.push(frame.map_err(at_agent)?);
        }
        self.check_agents(index, byte, agents)
    }

    /// Ids and positions (world, m) of the agents of one frame, in the order of ids; several times as fast as
    /// [`read_frame`](Self::read_frame).
    ///
    /// # Errors
    /// If there is no such frame or its bytes are altered.
    pub fn read_positions(&self, index: usize) -> Result<Vec<(AgentId, Vec2)>, RecordingError> {
        if self.frames.version == FORMAT_VERSION_1 {
            let mut agents = Vec::new();
            self.read_frame(index, &mut agents)?;
            return Ok(agents.iter().map(|agent| (agent.id, agent.root.position_m)).collect());
        }
        let byte = *self.frames.bytes.get(index).ok_or_else(|| self.no_such_frame(index))?;
        let payload = self.file.read_chunk(byte, FRAME, most_frame_bytes(self.agent_count(index), ROW_BYTES))?;
        let compressed = self.compressed_rows(index, byte, &payload, ROW_BYTES)?;
        let positions_m = frame_chunk::read_positions(compressed, self.agent_count(index))
            .ok_or_else(|| self.damaged_frame(index, byte))?;
        positions_m.iter().try_for_each(|(id, _)| self.check_present(*id, index, byte))?;
        Ok(positions_m)
    }

    /// Replaces `rotations` by those of the extra joints in one frame, relative to their parents: agent by agent as in
    /// [`read_frame`](Self::read_frame), each with the joints that the header lists. None where the header lists none.
    ///
    /// # Errors
    /// If there is no such frame or its bytes are altered.
    pub fn read_extra(&self, index: usize, rotations: &mut Vec<Quat>) -> Result<(), RecordingError> {
        rotations.clear();
        let (joints, agents) = (self.header.extra_joints.len(), self.agent_count(index));
        if index >= self.frame_count() {
            return Err(self.no_such_frame(index));
        }
        let Some(&byte) = self.frames.extra_bytes.get(index) else { return Ok(()) };
        let row_bytes = joints * EXTRA_JOINT_BYTES;
        let payload = self.file.read_chunk(byte, EXTRA, most_frame_bytes(agents, row_bytes))?;
        let rows = self.rows(index, byte, &payload, row_bytes)?;
        rotations.try_reserve(agents * joints).map_err(|_| self.file.out_of_memory())?;
        rotations.extend(read_extra_rows(&rows));
        Ok(())
    }

    /// The rows of all agents of a frame, of `row_bytes` bytes each, in the payload of the chunk at `byte`.
    fn rows(&self, index: usize, byte: u64, payload: &[u8], row_bytes: usize) -> Result<Vec<u8>, RecordingError> {
        let compressed = self.compressed_rows(index, byte, payload, row_bytes)?;
        decompress(compressed, row_bytes, self.agent_count(index)).ok_or_else(|| self.damaged_frame(index, byte))
    }

    /// As [`Self::rows`], still compressed.
    fn compressed_rows<'a>(
        &self,
        index: usize,
        byte: u64,
        payload: &'a [u8],
        row_bytes: usize,
    ) -> Result<&'a [u8], RecordingError> {
        let expected = FrameStart { number: index as u32, agent_count: self.agent_count(index) };
        match frame_chunk::start(payload, row_bytes) {
            Some((start, compressed)) if start == expected => Ok(compressed),
            _ => Err(self.damaged_frame(index, byte)),
        }
    }

    fn damaged_frame(&self, index: usize, byte: u64) -> RecordingError {
        self.file.damaged(byte, format!("this is not frame {index} with {} agents", self.agent_count(index)))
    }

    fn no_such_frame(&self, index: usize) -> RecordingError {
        RecordingError::NoSuchFrame { path: self.file.path().to_owned(), index, count: self.frame_count() }
    }

    /// Checks that the agents of a frame are those that are present in it, in known states.
    fn check_agents(&self, index: usize, byte: u64, agents: &[AgentFrame]) -> Result<(), RecordingError> {
        for agent in agents {
            self.check_present(agent.id, index, byte)?;
            if usize::from(agent.state) >= self.header.states.len() {
                let what = format!("the state of agent {} in frame {index} has no name", agent.id.0);
                return Err(self.file.damaged(byte, what));
            }
        }
        Ok(())
    }

    fn check_present(&self, id: AgentId, index: usize, byte: u64) -> Result<(), RecordingError> {
        match self.population.agents.get(id.index()) {
            Some(life) if life.is_present(index as u32) => Ok(()),
            _ => Err(self.file.damaged(byte, format!("agent {} is not present in frame {index}", id.0))),
        }
    }

    /// As [`Self::read_frame`], from a payload of version 1.
    fn read_frame_of_version_1(
        &self,
        index: usize,
        byte: u64,
        payload: &[u8],
        agents: &mut Vec<AgentFrame>,
    ) -> Result<(), RecordingError> {
        let rows = decompress(payload, PACKED_BYTES, self.agent_count(index))
            .ok_or_else(|| self.file.damaged(byte, "the frame does not hold the scenario's agents"))?;
        for (agent, packed) in rows.chunks_exact(PACKED_BYTES).enumerate() {
            let path = self.file.path().to_owned();
            let at_agent = |fault| RecordingError::Frame { path, byte, frame: index, agent, fault };
            agents.push(AgentFrame { id: agent.into(), ..unpack_version_2(packed).map_err(at_agent)? });
        }
        Ok(())
    }
}

/// Greatest length of a frame's payload: zlib makes nothing that is hard to compress much longer.
fn most_frame_bytes(agent_count: usize, row_bytes: usize) -> u64 {
    (2 * agent_count * row_bytes) as u64 + 1024
}

/// The format version, if the file is a recording of a known one.
fn read_version(file: &ChunkFile) -> Result<u32, RecordingError> {
    let foreign = || RecordingError::Foreign { path: file.path().to_owned() };
    if file.length() < MAGIC.len() as u64 || file.read(0, MAGIC.len() as u64)? != MAGIC {
        return Err(foreign());
    }
    let version = file.read(MAGIC.len() as u64, 4)?;
    match u32::from_le_bytes(version.try_into().map_err(|_| foreign())?) {
        known @ (FORMAT_VERSION_1..=FORMAT_VERSION) => Ok(known),
        found => Err(RecordingError::Version { path: file.path().to_owned(), found }),
    }
}

/// The byte at which the index begins.
fn index_byte(file: &ChunkFile) -> Result<u64, RecordingError> {
    let tail_byte = file.length().saturating_sub(TAIL_BYTES);
    match file.read_chunk(tail_byte, TAIL, TAIL_BYTES)?.try_into() {
        Ok(bytes) => Ok(u64::from_le_bytes(bytes)),
        Err(_) => Err(file.damaged(tail_byte, "the last chunk names no index")),
    }
}

/// The byte at which each frame's chunk begins, that of its extra joints where the header lists any, and that of the
/// agents' chunk.
fn read_index(file: &ChunkFile, has_extra_joints: bool) -> Result<([Vec<u64>; 2], u64), RecordingError> {
    let index_byte = index_byte(file)?;
    let index = file.read_chunk(index_byte, INDEX, INDEX_LIMIT_BYTES)?;
    let (entries, []) = index.as_chunks::<INDEX_ENTRY_BYTES>() else {
        return Err(file.damaged(index_byte, "the index is not whole"));
    };
    let (mut frame_bytes, mut extra_bytes, mut agents_bytes, mut before) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for entry in entries {
        let [k0, k1, k2, k3, byte @ ..] = *entry;
        let byte = u64::from_le_bytes(byte);
        // So that a short file cannot claim many frames.
        if byte <= before {
            return Err(file.damaged(index_byte, "the index does not rise"));
        }
        before = byte;
        match [k0, k1, k2, k3] {
            FRAME => frame_bytes.push(byte),
            EXTRA if has_extra_joints => extra_bytes.push(byte),
            AGENTS => agents_bytes.push(byte),
            _ => {}
        }
    }
    match agents_bytes[..] {
        _ if frame_bytes.is_empty() => Err(file.damaged(index_byte, "the index is empty: it names no frame")),
        _ if has_extra_joints && extra_bytes.len() != frame_bytes.len() => {
            Err(file.damaged(index_byte, "the index does not name the extra joints of each frame"))
        }
        [agents_byte] => Ok(([frame_bytes, extra_bytes], agents_byte)),
        _ => Err(file.damaged(index_byte, "the index does not name one list of agents")),
    }
}

fn read_population(
    file: &ChunkFile,
    header: &Header,
    agents_byte: u64,
    frame_count: usize,
) -> Result<Population, RecordingError> {
    let payload = file.read_chunk(agents_byte, AGENTS, zipped_json::PAYLOAD_MAX_BYTES)?;
    agents_chunk::read(&payload, header, frame_count)
        .map_err(|what| file.damaged(agents_byte, format!("the list of agents is not valid ({what})")))
}

/// Number of agents in each frame.
fn agent_counts(population: &Population, frame_count: usize) -> Vec<u32> {
    let mut changes = vec![0_i64; frame_count];
    for life in &population.agents {
        changes[life.born as usize] += 1;
        if let Some(removed) = life.removed {
            changes[removed as usize] -= 1;
        }
    }
    let mut present = 0;
    let count = |change: i64| {
        present += change;
        present as u32
    };
    changes.into_iter().map(count).collect()
}

//! `.fbrec`: a simulation, recorded frame by frame while it runs; self-contained, any frame readable without the
//! others.
//!
//! A magic of 8 bytes (among them those that a transfer in text mode would change), the format version as u32, then
//! chunks, little-endian:
//!
//! - `HEAD` comes first: the [`Header`], bincode with fixed-size integers;
//! - one `FRAM` a frame: zlib over the packed agents, all their first bytes, all their
//!   second bytes, …;
//! - `INDX`: the byte at which each `FRAM` begins, u64 each;
//! - `TAIL` ends the file: the byte at which `INDX` begins, u64.
//!
//! Frame 0 is the start, frame k the state after k steps. The writer holds one frame and the offsets, the reader the
//! header and the offsets.

pub(crate) mod chunk;
pub(crate) mod error;
pub(crate) mod frame;
pub(crate) mod packing;
pub(crate) mod replay;

pub use chunk::{CHUNK_HEAD_BYTES, ChunkFile, Kind, write_chunk};
pub use error::RecordingError;
pub use frame::AgentFrame;
pub use packing::{PACKED_BYTES, unpack};
pub use replay::{RecordedStep, Replay};

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use glam::Vec3;
use motiondb::body::Skeleton;
use motiondb::files::atomic_file::{self, AtomicFile};
use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use serde::{Deserialize, Serialize};

use crate::recording::packing::pack;
use crate::scenario::Scenario;
use crate::scenario::ranges::check_ranges;

/// Raised when a reader of the old version would misread the new one.
pub const FORMAT_VERSION: u32 = 1;

const MAGIC: [u8; 8] = *b"FBREC\r\n\x1a";
const HEAD_BYTE: u64 = 12;
const TAIL_BYTES: u64 = CHUNK_HEAD_BYTES + 8;
const HEAD: Kind = *b"HEAD";
const FRAME: Kind = *b"FRAM";
const INDEX: Kind = *b"INDX";
const TAIL: Kind = *b"TAIL";
/// Longer is no bone, m, and greater no angle of a joint, rad.
const SKELETON_MAX_M: f32 = 10.0;
/// No body of whatever size comes near, m/s.
const SPEED_MAX_MPS: f32 = 100.0;
/// No header of a million agents with waypoints comes near; bincode refuses to decode beyond it.
const HEADER_LIMIT_BYTES: usize = 1 << 30;

/// What a recording says once. No timings, no dates, no paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// CRC-32 of the database that the bodies came from.
    pub database_checksum: u32,
    /// The bodies: bones, soles, capsules.
    pub skeleton: Skeleton,
    /// What the database lets a body walk at: with it, any step can be planned again.
    pub velocity_hull: VelocityHull,
    /// The whole scenario: agents, obstacles, parameters, dt, view.
    pub scenario: Scenario,
}

impl Header {
    /// Of a scenario that bodies from a database play.
    pub fn new(db: &MotionDb, database_checksum: u32, scenario: Scenario) -> Self {
        let (skeleton, velocity_hull) = (db.skeleton.clone(), db.velocity_hull.clone());
        Self { database_checksum, skeleton, velocity_hull, scenario }
    }
}

/// Writes a recording; without [`Recorder::finish`] nothing is left.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: AtomicFile,
    agent_count: usize,
    /// Where the next chunk begins.
    byte: u64,
    frame_bytes: Vec<u64>,
    packed: Vec<u8>,
    /// Kept from frame to frame, because its tables are larger than a small crowd's frame.
    zlib: ZlibEncoder<Vec<u8>>,
}

impl Recorder {
    /// Begins a recording under a temporary name beside `path`.
    ///
    /// # Errors
    /// Where the folder cannot be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordingError> {
        let fail = |source| RecordingError::Unwritable { path: path.to_owned(), source };
        let payload =
            bincode::serde::encode_to_vec(header, bincode_config()).map_err(|error| fail(io::Error::other(error)))?;
        // Of a long run that was stopped, hundreds of megabytes would stay.
        atomic_file::sweep(path);
        let mut file = AtomicFile::create(path).map_err(fail)?;
        file.writer().write_all(&MAGIC).map_err(fail)?;
        file.writer().write_all(&FORMAT_VERSION.to_le_bytes()).map_err(fail)?;
        let mut recorder = Self {
            path: path.to_owned(),
            file,
            agent_count: header.scenario.agents.len(),
            byte: HEAD_BYTE,
            frame_bytes: Vec::new(),
            packed: Vec::new(),
            zlib: ZlibEncoder::new(Vec::new(), Compression::fast()),
        };
        recorder.write(HEAD, &payload)?;
        Ok(recorder)
    }

    /// Appends one frame: every agent of the scenario, in index order.
    ///
    /// # Errors
    /// Where the disk is full, the number of agents is wrong or a value is not finite.
    pub fn push(&mut self, agents: &[AgentFrame]) -> Result<(), RecordingError> {
        let (path, frame) = (&self.path, self.frame_bytes.len());
        if agents.len() != self.agent_count {
            let (found, expected) = (agents.len(), self.agent_count);
            return Err(RecordingError::AgentCount { path: path.clone(), frame, found, expected });
        }
        self.packed.clear();
        for (agent, values) in agents.iter().enumerate() {
            pack(values, &mut self.packed).ok_or_else(|| RecordingError::NotFinite {
                path: path.clone(),
                frame,
                agent,
            })?;
        }
        let payload = compress(&mut self.zlib, &self.packed)
            .map_err(|source| RecordingError::Unwritable { path: path.clone(), source })?;
        self.frame_bytes.push(self.byte);
        self.write(FRAME, &payload)
    }

    /// Writes the index and gives the recording its name.
    ///
    /// # Errors
    /// Where the disk is full or the file cannot be renamed.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        let index_byte = self.byte;
        let index: Vec<u8> = self.frame_bytes.iter().flat_map(|byte| byte.to_le_bytes()).collect();
        self.write(INDEX, &index)?;
        self.write(TAIL, &index_byte.to_le_bytes())?;
        let Self { path, file, .. } = self;
        file.commit().map_err(|source| RecordingError::Unwritable { path, source })
    }

    fn write(&mut self, kind: Kind, payload: &[u8]) -> Result<(), RecordingError> {
        write_chunk(self.file.writer(), kind, payload)
            .map_err(|source| RecordingError::Unwritable { path: self.path.clone(), source })?;
        self.byte += CHUNK_HEAD_BYTES + payload.len() as u64;
        Ok(())
    }
}

/// A recording that was opened; frames are read when asked for, from any thread.
#[derive(Debug)]
pub struct Recording {
    file: ChunkFile,
    header: Header,
    frame_bytes: Vec<u64>,
}

impl Recording {
    /// Reads header and index, and checks them; each frame is checked when it is read.
    ///
    /// # Errors
    /// Where the file is none, of another version, cut short or altered.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = ChunkFile::open(path)?;
        check_magic(&file)?;
        let header = decode_header(&file)?;
        let frame_bytes = read_index(&file)?;
        Ok(Self { file, header, frame_bytes })
    }

    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Frames, the start included: steps + 1, so at least one.
    pub fn frame_count(&self) -> usize {
        self.frame_bytes.len()
    }

    /// Replaces `agents` by those of one frame, in index order.
    ///
    /// # Errors
    /// Where there is no such frame or its bytes are altered.
    pub fn read_frame(&self, index: usize, agents: &mut Vec<AgentFrame>) -> Result<(), RecordingError> {
        let count = self.frame_count();
        let byte = *self.frame_bytes.get(index).ok_or_else(|| RecordingError::NoSuchFrame {
            path: self.file.path().to_owned(),
            index,
            count,
        })?;
        let payload = self.file.read_chunk(byte, FRAME)?;
        let packed = decompress(&payload, self.header.scenario.agents.len())
            .ok_or_else(|| self.file.damaged(byte, "the frame does not hold the scenario's agents"))?;
        agents.clear();
        for bytes in packed.chunks_exact(PACKED_BYTES) {
            agents.push(unpack(bytes).map_err(|what| self.file.damaged(byte, what))?);
        }
        Ok(())
    }
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

fn decode_header(file: &ChunkFile) -> Result<Header, RecordingError> {
    let payload = file.read_chunk(HEAD_BYTE, HEAD)?;
    let (header, used) = bincode::serde::decode_from_slice::<Header, _>(&payload, bincode_config())
        .map_err(|error| file.damaged(HEAD_BYTE, format!("the header cannot be decoded ({error})")))?;
    if used != payload.len() {
        return Err(file.damaged(HEAD_BYTE, "the header is longer than it says"));
    }
    // Whoever reads, measures or draws a recording may trust its numbers.
    check_ranges(&header.scenario).map_err(|fault| file.damaged(HEAD_BYTE, fault.message))?;
    if !is_bodily(&header.skeleton) {
        return Err(file.damaged(HEAD_BYTE, "the skeleton is no body's"));
    }
    if !is_walkable(&header.velocity_hull) {
        return Err(file.damaged(HEAD_BYTE, "the velocities are no body's"));
    }
    Ok(header)
}

/// Whether every bone, point and limit is finite and within reach of a giant's hand.
fn is_bodily(skeleton: &Skeleton) -> bool {
    let near = |vector: Vec3| vector.is_finite() && vector.abs().max_element() <= SKELETON_MAX_M;
    let feet = skeleton.feet.iter();
    let points_m = feet.flat_map(|foot| [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m));
    let vectors = [skeleton.offsets_m, skeleton.segment_ends_m].into_iter().flatten();
    let limits = skeleton.limits_rad.iter().flatten().copied();
    vectors.chain(limits).chain(points_m).all(near)
        && skeleton.segment_radii_m.iter().all(|radius_m| (0.0..=SKELETON_MAX_M).contains(radius_m))
}

/// Whether every velocity is finite and no faster than anybody runs.
fn is_walkable(hull: &VelocityHull) -> bool {
    let corners_mps = hull.turning_mps.iter().chain(&hull.holding_mps).chain(hull.sharp_turn_edges_mps.as_flattened());
    corners_mps.copied().all(|corner_mps| corner_mps.is_finite() && corner_mps.length() <= SPEED_MAX_MPS)
}

/// Where each frame's chunk begins.
fn read_index(file: &ChunkFile) -> Result<Vec<u64>, RecordingError> {
    let tail_byte = file.length().saturating_sub(TAIL_BYTES);
    let index_byte = match file.read_chunk(tail_byte, TAIL)?.try_into() {
        Ok(bytes) => u64::from_le_bytes(bytes),
        Err(_) => return Err(file.damaged(tail_byte, "the last chunk names no index")),
    };
    let index = file.read_chunk(index_byte, INDEX)?;
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

fn bincode_config() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<HEADER_LIMIT_BYTES>()
}

/// Neighbouring agents' bytes of equal meaning stand side by side, which makes what zlib leaves a twelfth smaller.
fn compress(zlib: &mut ZlibEncoder<Vec<u8>>, packed: &[u8]) -> io::Result<Vec<u8>> {
    zlib.write_all(&transpose(packed, PACKED_BYTES))?;
    zlib.reset(Vec::new())
}

/// The inverse of [`compress`]; none unless exactly `agent_count` agents come out.
fn decompress(payload: &[u8], agent_count: usize) -> Option<Vec<u8>> {
    let length = agent_count * PACKED_BYTES;
    let mut planes = Vec::with_capacity(length);
    // One byte more than wanted, to notice what is too long.
    ZlibDecoder::new(payload).take(length as u64 + 1).read_to_end(&mut planes).ok()?;
    (planes.len() == length).then(|| transpose(&planes, agent_count))
}

/// Rows of `columns` bytes become columns.
fn transpose(bytes: &[u8], columns: usize) -> Vec<u8> {
    let rows = bytes.len() / columns;
    let mut turned = vec![0; bytes.len()];
    for (row, values) in bytes.chunks_exact(columns).enumerate() {
        for (column, value) in values.iter().enumerate() {
            turned[column * rows + row] = *value;
        }
    }
    turned
}

//! The writer of a recording, frame by frame.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use motiondb::files::atomic_file::AtomicFile;

use crate::recording::chunk::write_chunk;
use crate::recording::compression::compress;
use crate::recording::error::RecordingError;
use crate::recording::format::{
    CHUNK_HEAD_BYTES, ChunkKind, FORMAT_VERSION, FRAME, HEAD, HEAD_BYTE, INDEX, MAGIC, TAIL,
};
use crate::recording::frame::AgentFrame;
use crate::recording::frame_packing::pack;
use crate::recording::header::Header;

/// Writes a recording. Without [`Recorder::finish`] no file is left.
///
/// ```no_run
/// use std::path::Path;
/// use std::sync::Arc;
///
/// use fbcrowd_sim::{Header, Recorder, Simulation, scenario};
/// use motiondb::files::database_file;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (db, checksum) = database_file::read(Path::new("motion.fbdb"))?;
/// let (scenario, _) = scenario::read(Path::new("antipodal.toml"))?;
/// let steps = (scenario.duration_s / scenario.dt_s) as usize;
/// let mut recorder = Recorder::create(Path::new("antipodal.fbrec"), &Header::new(&db, checksum, scenario.clone()))?;
/// let mut simulation = Simulation::new(Arc::new(db), &scenario);
/// recorder.push(simulation.frames())?;
/// for _ in 0..steps {
///     simulation.step(&mut |_stage| {});
///     recorder.push(simulation.frames())?;
/// }
/// recorder.finish()?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: AtomicFile,
    agent_count: usize,
    /// Byte at which the next chunk begins.
    byte: u64,
    /// Byte at which each frame's chunk begins.
    frame_bytes: Vec<u64>,
    /// Packed agents of one frame: working memory.
    packed: Vec<u8>,
    /// Kept from frame to frame, because its tables are larger than a small crowd's frame.
    zlib: ZlibEncoder<Vec<u8>>,
}

impl Recorder {
    /// Begins a recording under a temporary name beside `path`.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordingError> {
        let fail = |source| RecordingError::Unwritable { path: path.to_owned(), source };
        let payload = header.encode().map_err(|error| fail(io::Error::other(error)))?;
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
    /// If the disk is full, the number of agents is wrong or a value is not finite.
    pub fn push(&mut self, agents: &[AgentFrame]) -> Result<(), RecordingError> {
        let (path, frame) = (&self.path, self.frame_bytes.len());
        if agents.len() != self.agent_count {
            let (found, expected) = (agents.len(), self.agent_count);
            return Err(RecordingError::AgentCount { path: path.clone(), frame, found, expected });
        }
        self.packed.clear();
        for (agent, values) in agents.iter().enumerate() {
            let not_finite = || RecordingError::NotFinite { path: path.clone(), frame, agent };
            pack(values, &mut self.packed).ok_or_else(not_finite)?;
        }
        let payload = compress(&mut self.zlib, &self.packed)
            .map_err(|source| RecordingError::Unwritable { path: path.clone(), source })?;
        self.frame_bytes.push(self.byte);
        self.write(FRAME, &payload)
    }

    /// Writes the index and gives the recording its name.
    ///
    /// # Errors
    /// If the disk is full or the file cannot be renamed.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        let index_byte = self.byte;
        let index: Vec<u8> = self.frame_bytes.iter().flat_map(|byte| byte.to_le_bytes()).collect();
        self.write(INDEX, &index)?;
        self.write(TAIL, &index_byte.to_le_bytes())?;
        let Self { path, file, .. } = self;
        file.commit().map_err(|source| RecordingError::Unwritable { path, source })
    }

    fn write(&mut self, kind: ChunkKind, payload: &[u8]) -> Result<(), RecordingError> {
        write_chunk(self.file.writer(), kind, payload)
            .map_err(|source| RecordingError::Unwritable { path: self.path.clone(), source })?;
        self.byte += CHUNK_HEAD_BYTES + payload.len() as u64;
        Ok(())
    }
}

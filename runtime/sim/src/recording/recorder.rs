//! The writer of a recording, frame by frame.

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::Quat;
use motiondb::files::atomic_file::AtomicFile;

use crate::population::{AgentId, Population};
use crate::recording::agents_chunk;
use crate::recording::chunk::write_chunk;
use crate::recording::error::RecordingError;
use crate::recording::format::{
    AGENTS, CHUNK_HEAD_BYTES, ChunkKind, EXTRA, FORMAT_VERSION, FRAME, HEAD, HEAD_BYTE, INDEX, MAGIC, TAIL,
};
use crate::recording::frame::AgentFrame;
use crate::recording::frame_chunk::{EXTRA_JOINT_BYTES, ROW_BYTES, append_extra_row, append_row, compress};
use crate::recording::header::Header;
use crate::recording::zipped_json;

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
/// recorder.finish(simulation.population())?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: AtomicFile,
    header: Header,
    /// Byte at which the next chunk begins.
    byte: u64,
    /// Entries of the index so far.
    index: Vec<u8>,
    frame_count: u32,
    /// Frames of birth and of removal of every agent so far, by id.
    lives: Vec<(u32, Option<u32>)>,
    /// Ids of the last frame.
    present: Vec<AgentId>,
    /// Rows of one frame: working memory.
    rows: Vec<u8>,
    /// Rows of the extra joints of one frame: working memory.
    extra_rows: Vec<u8>,
    /// Kept from frame to frame, because its tables are larger than a small crowd's frame.
    zlib: ZlibEncoder<Vec<u8>>,
}

impl Recorder {
    /// Begins a recording under a temporary name beside `path`.
    ///
    /// # Errors
    /// If the header is not valid or the folder cannot be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordingError> {
        let fail = |source| RecordingError::Unwritable { path: path.to_owned(), source };
        header.check().map_err(|what| RecordingError::Header { path: path.to_owned(), what })?;
        let payload = zipped_json::encode(header).map_err(fail)?;
        let mut file = AtomicFile::create(path).map_err(fail)?;
        file.writer().write_all(&MAGIC).map_err(fail)?;
        file.writer().write_all(&FORMAT_VERSION.to_le_bytes()).map_err(fail)?;
        let mut recorder = Self {
            path: path.to_owned(),
            file,
            header: header.clone(),
            byte: HEAD_BYTE,
            index: Vec::new(),
            frame_count: 0,
            lives: Vec::new(),
            present: Vec::new(),
            rows: Vec::new(),
            extra_rows: Vec::new(),
            zlib: ZlibEncoder::new(Vec::new(), Compression::fast()),
        };
        recorder.write(HEAD, &payload)?;
        Ok(recorder)
    }

    /// Appends one frame: every present agent, in the order of ids. The header must list no extra joints.
    ///
    /// # Errors
    /// If the disk is full, an agent is missing from the start, an id is not the next one, or a value is not finite.
    pub fn push(&mut self, agents: &[AgentFrame]) -> Result<(), RecordingError> {
        self.push_with_extra(agents, [])
    }

    /// Appends one frame as [`push`](Self::push) does, and for each agent the rotations of the extra joints that the
    /// header lists, relative to their parents.
    ///
    /// # Errors
    /// As of [`push`](Self::push); if an agent has other extra joints than the header lists.
    pub fn push_with_extra<'a>(
        &mut self,
        agents: &[AgentFrame],
        extra: impl IntoIterator<Item = &'a [Quat]>,
    ) -> Result<(), RecordingError> {
        let (path, frame) = (&self.path, self.frame_count as usize);
        let listed = self.header.scenario.agents.len();
        if frame == 0 && agents.len() < listed {
            return Err(RecordingError::AgentCount { path: path.clone(), found: agents.len(), expected: listed });
        }
        self.rows.clear();
        let mut before = None;
        for values in agents {
            let agent = values.id.index();
            let is_state = usize::from(values.state) < self.header.states.len();
            if before.is_some_and(|before| before >= values.id) || !is_state {
                return Err(RecordingError::AgentId { path: path.clone(), frame, agent });
            }
            let not_finite = || RecordingError::NotFinite { path: path.clone(), frame, agent };
            append_row(values, before, &mut self.rows).ok_or_else(not_finite)?;
            before = Some(values.id);
        }
        self.append_extra(agents, extra)?;
        self.follow_lives(agents)?;
        let unwritable = |source| RecordingError::Unwritable { path: self.path.clone(), source };
        let payload = compress(self.frame_count, &mut self.zlib, &self.rows, ROW_BYTES).map_err(unwritable)?;
        let joints = self.header.extra_joints.len();
        let extra = (joints > 0)
            .then(|| compress(self.frame_count, &mut self.zlib, &self.extra_rows, joints * EXTRA_JOINT_BYTES))
            .transpose()
            .map_err(unwritable)?;
        self.frame_count += 1;
        self.write_indexed(FRAME, &payload)?;
        extra.map_or(Ok(()), |payload| self.write_indexed(EXTRA, &payload))
    }

    /// Makes the rows of the extra joints of a frame.
    fn append_extra<'a>(
        &mut self,
        agents: &[AgentFrame],
        extra: impl IntoIterator<Item = &'a [Quat]>,
    ) -> Result<(), RecordingError> {
        let (frame, expected) = (self.frame_count as usize, self.header.extra_joints.len());
        let mut extra = extra.into_iter();
        self.extra_rows.clear();
        for agent in agents {
            let (agent, rotations) = (agent.id.index(), extra.next().unwrap_or_default());
            let found = rotations.len();
            if found != expected {
                let path = self.path.clone();
                return Err(RecordingError::ExtraJointCount { path, frame, agent, found, expected });
            }
            let not_finite = || RecordingError::NotFinite { path: self.path.clone(), frame, agent };
            append_extra_row(rotations, &mut self.extra_rows).ok_or_else(not_finite)?;
        }
        Ok(())
    }

    /// Notes the agents that are born and removed in a frame.
    fn follow_lives(&mut self, agents: &[AgentFrame]) -> Result<(), RecordingError> {
        let frame = self.frame_count;
        let mut ids = agents.iter().map(|agent| agent.id).peekable();
        for &id in &self.present {
            match ids.peek() {
                Some(next) if *next == id => drop(ids.next()),
                _ => self.lives[id.index()].1 = Some(frame),
            }
        }
        for id in ids {
            if id.index() != self.lives.len() {
                let (path, frame, agent) = (self.path.clone(), frame as usize, id.index());
                return Err(RecordingError::AgentId { path, frame, agent });
            }
            self.lives.push((frame, None));
        }
        self.present.clear();
        self.present.extend(agents.iter().map(|agent| agent.id));
        Ok(())
    }

    /// Writes the agents and the index, and gives the recording its name. Births and removals are as the frames show
    /// them; all else of an agent is as the population states it.
    ///
    /// # Errors
    /// If the population lists another number of agents than the frames, the disk is full, or the file cannot be
    /// renamed.
    pub fn finish(mut self, population: &Population) -> Result<(), RecordingError> {
        let (found, expected) = (self.lives.len(), population.agents.len());
        if found != expected && self.frame_count > 0 {
            return Err(RecordingError::AgentCount { path: self.path, found, expected });
        }
        let mut population = population.clone();
        for (life, &(born, removed)) in population.agents.iter_mut().zip(&self.lives) {
            (life.born, life.removed) = (born, removed);
        }
        let payload = zipped_json::encode(&agents_chunk::stored(&population, &self.header))
            .map_err(|source| RecordingError::Unwritable { path: self.path.clone(), source })?;
        self.write_indexed(AGENTS, &payload)?;
        let index_byte = self.byte;
        let index = std::mem::take(&mut self.index);
        self.write(INDEX, &index)?;
        self.write(TAIL, &index_byte.to_le_bytes())?;
        let Self { path, file, .. } = self;
        file.commit().map_err(|source| RecordingError::Unwritable { path, source })
    }

    /// Writes a chunk that the index names.
    fn write_indexed(&mut self, kind: ChunkKind, payload: &[u8]) -> Result<(), RecordingError> {
        self.index.extend(kind);
        self.index.extend(self.byte.to_le_bytes());
        self.write(kind, payload)
    }

    fn write(&mut self, kind: ChunkKind, payload: &[u8]) -> Result<(), RecordingError> {
        write_chunk(self.file.writer(), kind, payload)
            .map_err(|source| RecordingError::Unwritable { path: self.path.clone(), source })?;
        self.byte += CHUNK_HEAD_BYTES + payload.len() as u64;
        Ok(())
    }
}

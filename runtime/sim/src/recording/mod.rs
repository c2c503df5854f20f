//! `.fbrec`: a simulation, recorded frame by frame while it runs; self-contained, any frame readable without the
//! others.
//!
//! Enters: the frames of a running simulation. Leaves: a file, and from it any frame, and the planner's view of any
//! step.
//!
//! A file begins with an 8-byte magic number; it contains CR and LF, so that text-mode transfer damage is detected. The
//! format version follows as u32, then chunks, little-endian (docs/fbrec.md):
//!
//! - `HEAD` comes first: the [`Header`], zipped JSON;
//! - one `FRAM` per frame: its number, then zlib over the byte-shuffled agents, each with its id;
//! - after each `FRAM`, where bodies have joints beside the 22 roles, `EXTR`: their rotations;
//! - `AGNT`: all agents that ever were, from birth to removal, zipped JSON;
//! - `INDX`: kind of each `FRAM`, `EXTR` and `AGNT`, and the byte at which it begins;
//! - `TAIL` ends the file: the byte at which `INDX` begins, u64.
//!
//! Frame 0 is the start, frame k the state after k steps. The writer holds one frame and the index, the reader the
//! header, the agents and the index.
//!
//! Read `frame` (the recorded state of an agent), `header`, `recorder` and `reader`; then the layers below: `format`
//! (magic, version, chunk kinds), `chunk`, `frame_chunk`, `frame_packing` with `rotation_packing`, `agents_chunk`,
//! `zipped_json`, `error`. `version_1` reads older files. `replay` gives the planner's view of a recorded step, `playback`
//! the bodies at any time.

pub(crate) mod agents_chunk;
pub(crate) mod chunk;
pub(crate) mod error;
pub(crate) mod format;
pub(crate) mod frame;
pub(crate) mod frame_chunk;
pub(crate) mod frame_packing;
pub(crate) mod header;
pub(crate) mod playback;
pub(crate) mod reader;
pub(crate) mod recorder;
pub(crate) mod replay;
pub(crate) mod rotation_packing;
mod version_1;
pub(crate) mod zipped_json;

pub use chunk::write_chunk;
pub use error::RecordingError;
pub use format::{CHUNK_HEAD_BYTES, ChunkKind, FORMAT_VERSION, FORMAT_VERSION_1};
pub use frame::AgentFrame;
pub use frame_packing::{FrameFault, PACKED_BYTES, unpack};
pub use header::{Header, RecordedCharacter, RecordedDatabase, RecordedExtraJoint};
pub use playback::{ExtraFrame, FrameTimes, duration_s, sample, sample_extra};
pub use reader::Recording;
pub use recorder::Recorder;
pub use replay::{RecordedStep, Replay};
pub use zipped_json::{unzip_text, zip_text};

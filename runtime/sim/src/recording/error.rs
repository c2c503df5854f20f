//! Errors of a recording: each names the file, the byte or frame, what is wrong there and how to mend it.

use std::io;
use std::path::PathBuf;

use crate::recording::format::FORMAT_VERSION;
use crate::recording::frame_packing::FrameFault;

/// Why a recording cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The system cannot write the file.
    #[error("{}: cannot be written: {source}; check that its folder exists, may be written and has room", path.display())]
    Unwritable {
        /// The recording.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system cannot read the file.
    #[error("{}: cannot be read: {source}; check that the file exists and may be read", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is not a recording.
    #[error("{}: byte 0: not an FbCrowd recording; name a .fbrec file that `fbcrowd simulate` wrote", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// Another version of the program wrote the file.
    #[error(
        "{}: byte 8: format version {found}, but this program reads version {FORMAT_VERSION}; simulate the scenario again",
        path.display()
    )]
    Version {
        /// The recording.
        path: PathBuf,
        /// Its format version.
        found: u32,
    },
    /// Lengths, checksums or contents do not fit together.
    #[error("{}: byte {byte}: {what}; the file was cut short or altered: simulate the scenario again", path.display())]
    Damaged {
        /// The recording.
        path: PathBuf,
        /// The byte from the start of the file.
        byte: u64,
        /// What is wrong there.
        what: String,
    },
    /// The bytes of an agent in a frame are not valid.
    #[error("{}: frame {frame}, agent {agent}: {fault}; the file was altered: simulate the scenario again", path.display())]
    Frame {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Index of the agent.
        agent: usize,
        /// What is wrong with its bytes.
        fault: FrameFault,
    },
    /// The recording has no such frame.
    #[error("{}: there is no frame {index}: the recording has {count}, counted from 0", path.display())]
    NoSuchFrame {
        /// The recording.
        path: PathBuf,
        /// Index of the requested frame.
        index: usize,
        /// Number of frames in the recording.
        count: usize,
    },
    /// A frame to be recorded has another number of agents than the header.
    #[error("{}: frame {frame} holds {found} agents, but the scenario has {expected}", path.display())]
    AgentCount {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Number of agents in the frame.
        found: usize,
        /// Number of agents in the header's scenario.
        expected: usize,
    },
    /// A frame to be recorded holds a value that is not finite, or beyond all scenarios.
    #[error("{}: frame {frame}: agent {agent} is not finite: the simulation is broken, not its input", path.display())]
    NotFinite {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Index of the agent.
        agent: usize,
    },
}

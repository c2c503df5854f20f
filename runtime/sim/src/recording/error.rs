//! Errors of a recording: each names the file, the byte or frame, what is wrong there and how to mend it.

use std::io;
use std::path::PathBuf;

use crate::recording::format::{FORMAT_VERSION, FORMAT_VERSION_1};
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
        "{}: byte 8: format version {found}, but this program reads versions {FORMAT_VERSION_1} to {FORMAT_VERSION}; simulate the scenario again",
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
    #[error(
        "{}: byte {byte}: frame {frame}, agent {agent}: {fault}; the file was altered: simulate the scenario again",
        path.display()
    )]
    Frame {
        /// The recording.
        path: PathBuf,
        /// The byte at which the frame's chunk begins.
        byte: u64,
        /// Index of the frame.
        frame: usize,
        /// Number of agents before it in the frame.
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
    /// A header to be recorded is not valid.
    #[error("{}: cannot be recorded: {what}", path.display())]
    Header {
        /// The recording.
        path: PathBuf,
        /// What is wrong with the header.
        what: String,
    },
    /// The first frame lacks agents of the scenario, or the frames show another number of agents than the population.
    #[error("{}: the frames hold {found} agents, but there are {expected}", path.display())]
    AgentCount {
        /// The recording.
        path: PathBuf,
        /// Number of agents in the frames.
        found: usize,
        /// Number of agents that there must be.
        expected: usize,
    },
    /// The ids of a frame to be recorded do not rise, leave one out, or bring a removed agent back.
    #[error("{}: frame {frame}: agent {agent} is not the next one: ids count births", path.display())]
    AgentId {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Id of the agent.
        agent: usize,
    },
    /// An agent to be recorded has other extra joints than the header lists.
    #[error("{}: frame {frame}: agent {agent} has {found} extra joints, but the header lists {expected}", path.display())]
    ExtraJointCount {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Id of the agent.
        agent: usize,
        /// Number of extra joints of the agent.
        found: usize,
        /// Number of extra joints in the header.
        expected: usize,
    },
    /// A frame to be recorded holds a value that is not finite, or beyond all scenarios.
    #[error("{}: frame {frame}: agent {agent} is not finite: the simulation is broken, not its input", path.display())]
    NotFinite {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Id of the agent.
        agent: usize,
    },
}

//! What can be wrong with a recording; each message names the file, the byte where it is wrong and what to do.

use std::io;
use std::path::PathBuf;

use crate::recording::FORMAT_VERSION;

/// Why a recording cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The system refuses to write.
    #[error("{}: cannot be written: {source}; check that its folder exists, may be written and has room", path.display())]
    Unwritable {
        /// The recording.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The system refuses to read.
    #[error("{}: cannot be read: {source}; check that the file exists and may be read", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is something else.
    #[error("{}: byte 0: not an FbCrowd recording; name a .fbrec file that `fbcrowd simulate` wrote", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// Another version of the program wrote it.
    #[error(
        "{}: byte 8: format version {found}, but this program reads version {FORMAT_VERSION}; simulate the scenario again",
        path.display()
    )]
    Version {
        /// The recording.
        path: PathBuf,
        /// The version it names.
        found: u32,
    },
    /// Lengths, checksums or contents do not fit together.
    #[error("{}: byte {byte}: {what}; the file was cut short or altered: simulate the scenario again", path.display())]
    Damaged {
        /// The recording.
        path: PathBuf,
        /// Where, from the start of the file.
        byte: u64,
        /// What is wrong there.
        what: String,
    },
    /// A frame was asked for that the recording does not have.
    #[error("{}: there is no frame {index}: the recording has {count}, counted from 0", path.display())]
    NoSuchFrame {
        /// The recording.
        path: PathBuf,
        /// Frame asked for.
        index: usize,
        /// Frames there are.
        count: usize,
    },
    /// A frame to be recorded does not fit the header.
    #[error("{}: frame {frame} holds {found} agents, but the scenario has {expected}", path.display())]
    AgentCount {
        /// The recording.
        path: PathBuf,
        /// Index of the frame.
        frame: usize,
        /// Agents in the frame.
        found: usize,
        /// Agents in the header's scenario.
        expected: usize,
    },
    /// A frame to be recorded holds NaN or infinity.
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

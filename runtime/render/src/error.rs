//! What can go wrong while drawing: each error names the file or the setting, the place in it and the remedy.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Everything that drawing can refuse.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The output folder can be neither found nor made.
    #[error("{}: the output folder cannot be made: {source}; name another, or allow writing there", folder.display())]
    Folder {
        /// The folder asked for.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A picture could not be written; nothing stands under its name.
    #[error("{}: the picture cannot be written: {source}; free some space or allow writing there, then render again", path.display())]
    Write {
        /// The picture's final name.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The view asks for a picture that cannot be drawn.
    #[error("the scenario's [view]: {message}; {help}")]
    View {
        /// The key, and what it lacks.
        message: String,
        /// What to do.
        help: &'static str,
    },
    /// `--frames` is not of the grammar.
    #[error(
        "frames \"{text}\": {fault} at \"{part}\"; write ranges as 1001-1100, every second frame as 1001-1100x2, single ones as 1010,1020"
    )]
    FrameRange {
        /// The whole text.
        text: String,
        /// The comma-separated part at fault.
        part: String,
        /// What is wrong with it.
        fault: FrameRangeFault,
    },
    /// `--frames` names only frames that the recording does not have.
    #[error("frames \"{text}\": none lies in the recording, which has {first} to {last}; name some of these")]
    NoFrames {
        /// The whole text.
        text: String,
        /// First frame of the recording.
        first: u32,
        /// Last frame of the recording.
        last: u32,
    },
    /// An overlay of an agent that the recording does not have.
    #[error("agent {agent}: the recording has {count}, 0 to {}; name one of these (each picture with an overlay tells their numbers)", count.saturating_sub(1))]
    NoSuchAgent {
        /// The agent asked for.
        agent: usize,
        /// Agents in the recording.
        count: usize,
    },
    /// More overlays than a picture has room for.
    #[error(
        "{asked} agents are too many panels for one picture, which has room for {room}; render some of them at a time"
    )]
    TooManyPanels {
        /// Panels asked for.
        asked: usize,
        /// Panels that fit beside the scene.
        room: usize,
    },
    /// An overlay of a recording in which nothing was planned.
    #[error("the recording holds no step, so nothing was planned; simulate for at least one step")]
    NoStep,
    /// The recording holds no frame at all.
    #[error("the recording holds no frame; simulate for at least one step")]
    EmptyRecording,
    /// The recording could not be read.
    #[error(transparent)]
    Recording(#[from] fbcrowd_sim::recording::RecordingError),
}

/// What is wrong with a part of a frame range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FrameRangeFault {
    /// A frame number is missing or not a number.
    #[error("a frame number is missing or not a number")]
    Number,
    /// The step is not a number.
    #[error("the step is not a number")]
    Step,
    /// The step is zero.
    #[error("the step is zero")]
    ZeroStep,
    /// The range ends before it begins.
    #[error("the range ends before it begins")]
    Reversed,
}

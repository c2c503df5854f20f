//! Errors of drawing. Each names the file or setting, the fault in it, and the remedy.

use std::io;
use std::path::PathBuf;

use glam::Vec3;
use thiserror::Error;

/// Reason why a picture cannot be drawn.
///
/// ```
/// use fbcrowd_render::FrameRange;
///
/// let error = "1001-".parse::<FrameRange>().unwrap_err();
/// assert!(error.to_string().starts_with("frames \"1001-\": a frame number is missing"));
/// ```
#[derive(Debug, Error)]
pub enum RenderError {
    /// The output folder cannot be made.
    #[error("{}: the output folder cannot be made: {source}; choose another, or allow writing there", folder.display())]
    Folder {
        /// Path of the folder.
        folder: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A picture cannot be written; no partial file is left.
    #[error("{}: the picture cannot be written: {source}; free some space or allow writing there, then render again", path.display())]
    Write {
        /// Final path of the picture.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The system has too little memory for the frames.
    #[error("the frames need {mib} MiB of memory, more than the system gives; use fewer threads or a smaller picture")]
    OutOfMemory {
        /// Memory that was not given, MiB.
        mib: usize,
    },
    /// The scenario's view is out of range.
    #[error("the scenario's [view]: {message}; {help}")]
    View {
        /// The key and its fault.
        message: String,
        /// The remedy.
        help: &'static str,
    },
    /// The text of `--frames` does not follow the grammar.
    #[error(
        "frames \"{text}\": {fault} at \"{part}\"; write ranges as 1001-1100, every second frame as 1001-1100x2, single ones as 1010,1020"
    )]
    FrameRange {
        /// The whole text.
        text: String,
        /// The comma-separated part at fault.
        part: String,
        /// The fault of the part.
        fault: FrameRangeFault,
    },
    /// The recording has none of the frames of `--frames`.
    #[error("frames \"{text}\": the sequence has only frames {first} to {last}; choose among those")]
    NoFrames {
        /// The whole text.
        text: String,
        /// First frame of the recording.
        first: u32,
        /// Last frame of the recording.
        last: u32,
    },
    /// The recording ends before the first frame of its shot.
    #[error(
        "the shot begins after {preroll_s} s, and the recording lasts {duration_s:.2} s; give a shorter `preroll_s` (or --preroll), or simulate longer"
    )]
    NothingAfterPreroll {
        /// Time before the first frame, s.
        preroll_s: f64,
        /// Time of the recording, s.
        duration_s: f64,
    },
    /// The recording does not have an agent that is to be shown.
    #[error("agent {agent} does not exist; the recording has {}; choose among these (--view camera --labels shows the numbers)", numbers(*.count))]
    NoSuchAgent {
        /// Index of the agent.
        agent: usize,
        /// Number of agents in the recording.
        count: usize,
    },
    /// A picture does not have room for so many overlays.
    #[error("{requested} panels do not fit in one picture, which has room for {room}; render fewer agents at once")]
    TooManyPanels {
        /// Number of panels requested.
        requested: usize,
        /// Number of panels that fit beside the scene.
        room: usize,
    },
    /// The recording of an overlay has no step, so nothing was planned.
    #[error("the recording holds no step, so nothing was planned; simulate for at least one step")]
    NoStep,
    /// The scenario has no camera of this name.
    #[error("there is no camera {name:?}; choose one of: {cameras}")]
    NoSuchCamera {
        /// The requested name.
        name: String,
        /// The cameras that exist.
        cameras: String,
    },
    /// A camera names a file that was not read.
    #[error("camera {camera:?}: the file that it names was not read; give the file itself by --cameras")]
    UnreadCamera {
        /// Name of the camera.
        camera: String,
    },
    /// The eye of a camera is inside a body or a wall, or under the ground.
    #[error(
        "camera {camera:?}: its eye at {eye_m:.2} m is {place} in frame {frame}; move the camera, or leave the frame out by --frames"
    )]
    EyeInside {
        /// Name of the camera.
        camera: String,
        /// The eye, m.
        eye_m: Vec3,
        /// What holds it, such as `inside agent 5`.
        place: String,
        /// Number of the frame.
        frame: u32,
    },
    /// The agent of a camera is not present.
    #[error(
        "camera {camera:?}: agent {agent} is not present at {time_s:.2} s; name another agent, or choose frames in which it is present by --frames"
    )]
    CameraAgent {
        /// Name of the camera.
        camera: String,
        /// Id of the agent.
        agent: u32,
        /// Time, s.
        time_s: f64,
    },
    /// The agent of a strip is not present.
    #[error("agent {agent} is not present at {time_s:.2} s; choose frames in which it is present by --frames")]
    AbsentAgent {
        /// Id of the agent.
        agent: u32,
        /// Time, s.
        time_s: f64,
    },
    /// A strip has no room for so many times.
    #[error(
        "{requested} frames do not fit in one strip, which has room for {room}; choose fewer by --frames, such as 1001-1120x6"
    )]
    TooManyTimes {
        /// Number of frames requested.
        requested: usize,
        /// Number of frames that fit.
        room: usize,
    },
    /// The recording has no agent of the number that a camera names.
    #[error("camera {camera:?}: there is no agent {agent}; the recording has {}", numbers(*.count))]
    UnknownCameraAgent {
        /// Name of the camera.
        camera: String,
        /// Id of the agent.
        agent: u32,
        /// Number of agents that are ever present.
        count: usize,
    },
    /// The recording has no frame.
    #[error("the recording holds no frame; simulate for at least one step")]
    EmptyRecording,
    /// The recording cannot be read.
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

/// Numbers of agents, in words.
fn numbers(count: usize) -> String {
    match count {
        0 => "none".to_owned(),
        1 => "agent 0 alone".to_owned(),
        _ => format!("agents 0 to {}", count - 1),
    }
}

//! Why a job fails: one enum, each variant with the path, the place in it and the remedy.

use std::io;
use std::path::{Path, PathBuf};

use fbcrowd_render::error::RenderError;
use fbcrowd_sim::recording::RecordingError;
use fbcrowd_sim::route::mesh::RouteError;
use fbcrowd_sim::scenario::ScenarioError;
use motiondb::files::Invalid;
use motiondb::files::file_kind::FileError;
use motiondb::files::input_file::is_of_machine;
use motiondb::motion::SourceRecord;
use motiondb_compiler::character::CharacterRejection;
use motiondb_compiler::{CompileError, Rejection};

/// Why a job fails.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// A mistake in the text of a scenario or a manifest.
    #[error(transparent)]
    Mistake(Box<Invalid>),
    /// All clips were read, and none gives an example.
    #[error("no clip gives an example; give clips of steady walking, running, turning or standing")]
    NoExample {
        /// Files and clips that cannot be used, each with its reason.
        rejected: Vec<Rejection>,
        /// Clips of human motion that give no example.
        sources: Vec<SourceRecord>,
    },
    /// No path was given.
    #[error("no clips are named; name files or folders")]
    NoPaths,
    /// The folder holds no clip.
    #[error("{}: no *.bvh, *.glb or *.gltf below it{instead}; name another folder or the clips themselves", folder.display())]
    NoClips {
        /// The first path that was given.
        folder: PathBuf,
        /// What it holds in their place; empty for nothing of motion.
        instead: String,
    },
    /// The manifest skips every clip.
    #[error("{}: leaves no clip to use; skip fewer", manifest.display())]
    AllSkipped {
        /// The manifest.
        manifest: PathBuf,
    },
    /// A set of clips has at most one manifest.
    #[error("{} and {} are two manifests; write one that names the folders of both", first.display(), second.display())]
    TwoManifests {
        /// One manifest.
        first: PathBuf,
        /// Another one.
        second: PathBuf,
    },
    /// The output would replace an input.
    #[error("{} is also an input; choose another output path", output.display())]
    OutputIsInput {
        /// The output path.
        output: PathBuf,
    },
    /// The output path names something that no output can replace.
    #[error("{} cannot be written: {fault}; choose another output path", output.display())]
    UnfitOutput {
        /// The output path.
        output: PathBuf,
        /// What is there.
        fault: String,
    },
    /// The path of a cache cannot be a folder.
    #[error("{} cannot be the folder of a cache: {fault}; name another folder", folder.display())]
    UnfitCache {
        /// Path of the cache.
        folder: PathBuf,
        /// Why the path cannot be a folder.
        fault: String,
    },
    /// Two outputs of one command would be written to the same file.
    #[error("{file} cannot be both {first} and {second}; give --{second} another name", file = output.display())]
    OneFileTwice {
        /// The output path.
        output: PathBuf,
        /// What is written there: one output.
        first: &'static str,
        /// The other one, as its option is called.
        second: &'static str,
    },
    /// Two outputs are links to one file.
    #[error("{} and {} are links to one file; remove one of the links", first.display(), second.display())]
    LinksToOneFile {
        /// One output.
        first: PathBuf,
        /// The other one.
        second: PathBuf,
    },
    /// Another process writes into the folder.
    #[error("another fbcrowd writes into {}; wait until it ends, or choose another folder", folder.display())]
    FolderInUse {
        /// The folder.
        folder: PathBuf,
    },
    /// The system does not allow writing a file or a folder.
    #[error("{} cannot be written: {source}; choose another path", path.display())]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system has too little memory for the crowd.
    #[error("{agents} agents need {mib} MiB of memory, more than the system gives; simulate fewer")]
    OutOfMemory {
        /// Number of agents.
        agents: usize,
        /// Memory that was not given, MiB.
        mib: usize,
    },
    /// The planner looks no further ahead than a change of synthesis takes (§3.4.1).
    #[error(
        "the planner looks {horizon_s} s ahead, but with this database a change of synthesis takes up to \
         {transition_s:.2} s; set `time_horizon_s` to more than that under [params.planner], or \
         `modes = \"blending\"` under [params.synthesis]"
    )]
    ShortHorizon {
        /// Time horizon of the planner, s.
        horizon_s: f32,
        /// Longest duration of a change between blending and semi-procedural locomotion, s.
        transition_s: f32,
    },
    /// A scenario names a style that the motion lacks.
    #[error("there is no style `{style}`; {}", styles(existing))]
    NoStyle {
        /// The style.
        style: String,
        /// The styles of the motion.
        existing: Vec<String>,
    },
    /// An agent changes its state again and again within one step.
    #[error(
        "after {time_s:.2} s agent {agent} changes between states `{states}` without end within one step; \
         add a condition to one of their transitions, as in `when = {{ after_s = 1 }}`"
    )]
    EndlessTransitions {
        /// The agent.
        agent: u32,
        /// Time of the step, s.
        time_s: f64,
        /// Names of the states.
        states: String,
    },
    /// A file has no camera.
    #[error("{}: there is no camera in it; export one with the scene", path.display())]
    NoCamera {
        /// The file.
        path: PathBuf,
    },
    /// A video's file has no extension of a container.
    #[error("{}: its extension names no kind of video; use .mp4, .mov or .mkv", path.display())]
    NoContainer {
        /// The path.
        path: PathBuf,
    },
    /// ffmpeg does not start.
    #[error(
        "{} does not start: {source}; a video needs ffmpeg: install it (`apt install ffmpeg`, `brew install ffmpeg`, \
         `winget install ffmpeg`), or name it by --ffmpeg; or write frames by -o", program.display()
    )]
    NoFfmpeg {
        /// The program.
        program: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// ffmpeg ended before the video was complete.
    #[error("{} ended early ({status}): {message}; no video is left: mend the cause, or write frames by -o", program.display())]
    FfmpegFailed {
        /// The program.
        program: PathBuf,
        /// How it ended.
        status: String,
        /// The end of its messages.
        message: String,
    },
    /// A scenario cannot be read.
    #[error(transparent)]
    Scenario(ScenarioError),
    /// No routes can be found on a scenario's ground.
    #[error(transparent)]
    Route(#[from] RouteError),
    /// The clips cannot be read, or give no valid database.
    #[error(transparent)]
    Compile(CompileError),
    /// A file of clips cannot be used.
    #[error(transparent)]
    Clip(#[from] Rejection),
    /// A file gives no character.
    #[error(transparent)]
    CharacterSource(#[from] CharacterRejection),
    /// Meshes of a compiled character are to be left out.
    #[error("{}: `hide` leaves out meshes of a GLB, glTF or VRM file; name the file that this one is compiled from", path.display())]
    CompiledMeshes {
        /// The compiled character.
        path: PathBuf,
    },
    /// The character of a recording is not beside it.
    #[error(
        "{} is missing: {} shows agents as this figure; keep the folder `characters` beside the recording, or simulate again",
        path.display(),
        recording.display()
    )]
    MissingCharacter {
        /// Where the character's file should be.
        path: PathBuf,
        /// The recording.
        recording: PathBuf,
    },
    /// A character beside a recording is not that of the simulation.
    #[error("{} is not the character of {}; simulate again, or restore the file", path.display(), recording.display())]
    OtherCharacter {
        /// The character's file.
        path: PathBuf,
        /// The recording.
        recording: PathBuf,
    },
    /// A database or a character cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A recording cannot be read or written.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A picture cannot be drawn or written.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// The styles that a database has, and what to do.
fn styles(existing: &[String]) -> String {
    match existing {
        [] => "the database has none; remove `style`, or compile clips of this style (docs/manifest.md)".to_owned(),
        names => format!("the database has {}; name one of these", names.join(", ")),
    }
}

impl JobError {
    /// The system does not allow writing `path`.
    pub fn unwritable(path: &Path, source: io::Error) -> Self {
        Self::Unwritable { path: path.to_owned(), source }
    }

    /// Whether the machine failed (disk, memory, permission), so that the same command may succeed later. Otherwise the
    /// command or its input is wrong.
    pub fn is_of_machine(&self) -> bool {
        match self {
            Self::Unwritable { .. } | Self::FolderInUse { .. } | Self::OutOfMemory { .. } => true,
            Self::NoFfmpeg { .. } | Self::FfmpegFailed { .. } => true,
            Self::File(FileError::Unreadable { source, .. }) => is_of_machine(source),
            Self::File(error) => matches!(error, FileError::Unwritable { .. }),
            Self::Recording(error) | Self::Render(RenderError::Recording(error)) => match error {
                RecordingError::Unwritable { .. } => true,
                RecordingError::Unreadable { source, .. } => is_of_machine(source),
                _ => false,
            },
            Self::Render(error) => {
                use RenderError::{Folder, OutOfMemory, Write};

                matches!(error, Folder { .. } | Write { .. } | OutOfMemory { .. })
            }
            Self::Scenario(ScenarioError::Unreadable { source, .. }) => is_of_machine(source),
            Self::Compile(error) => error.is_of_machine(),
            Self::Clip(rejection) => rejection.reason.is_of_machine(),
            Self::CharacterSource(rejection) => rejection.reason.is_of_machine(),
            _ => false,
        }
    }
}

impl From<ScenarioError> for JobError {
    fn from(error: ScenarioError) -> Self {
        match error {
            ScenarioError::Invalid(invalid) => Self::Mistake(invalid),
            ScenarioError::Unreadable { .. } => Self::Scenario(error),
        }
    }
}

impl From<CompileError> for JobError {
    fn from(error: CompileError) -> Self {
        match error {
            CompileError::InvalidManifest(invalid) => Self::Mistake(invalid),
            CompileError::NoExample { rejected, sources } => Self::NoExample { rejected, sources },
            other => Self::Compile(other),
        }
    }
}

//! The errors of this crate: why clips give no database.

use std::io;
use std::path::PathBuf;

use motiondb::files::{Invalid, input_file};
use motiondb::motion::{ActionKind, SourceRecord};

use crate::error::Rejection;

/// Why clips give no database.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// A folder of clips cannot be listed.
    #[error("{}: {source}; check that the folder exists and may be read", folder.display())]
    UnreadableFolder {
        /// The folder.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A manifest cannot be read as text.
    #[error("{}: cannot be read: {source}; check that the file exists and is text in UTF-8", manifest.display())]
    UnreadableManifest {
        /// The manifest.
        manifest: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A manifest breaks its format, or a clip contradicts it.
    #[error(transparent)]
    InvalidManifest(Box<Invalid>),
    /// The machine failed to read a clip: without it the database would be another one.
    #[error(transparent)]
    ClipUnread(Box<Rejection>),
    /// The system has too little memory for the analysis of all clips.
    #[error(
        "the analysis of the clips needs {mib} MiB of memory, more than the system gives; use fewer threads or clips"
    )]
    OutOfMemory {
        /// Memory that was not given, MiB.
        mib: usize,
    },
    /// No clip is given.
    #[error("no clips; name *.bvh, *.glb or *.gltf files or a folder that holds some")]
    NoClips,
    /// All clips were read, and none shows a steady gait or a body that stands.
    #[error(
        "no clip gives an example: {}; give clips of steady walking, running, turning or standing",
        reasons(rejected, sources)
    )]
    NoExample {
        /// Files and clips that are not human motion, each with its reason.
        rejected: Vec<Rejection>,
        /// Clips of human motion, each with its diagnostics.
        sources: Vec<SourceRecord>,
    },
    /// The clip that was chosen as the base walk does not walk ahead.
    #[error(
        "`{name}`: no walk straight ahead found; this clip cannot be the base walk (m_sp). Choose another with \
         `semi_procedural = \"…\"`"
    )]
    NotStepping {
        /// Name of the clip.
        name: String,
        /// Names of the clip's examples that walk ahead. Not empty where the choice named another window of the clip.
        stepping: Vec<String>,
    },
    /// A clip does not show the transition that a manifest states.
    #[error(
        "{file}: no {} was found; {}",
        kind.name(),
        transition_remedy(*kind)
    )]
    NoTransition {
        /// File of the clip.
        file: String,
        /// The stated kind.
        kind: ActionKind,
    },
    /// There is no clip of a style that alone is to be compiled.
    #[error("there is no style `{style}`; {}", of_styles(styles))]
    NoStyle {
        /// The style.
        style: String,
        /// The styles of the clips, the nearest name first.
        styles: Vec<String>,
    },
    /// The database breaks an invariant: a defect of the clips that no earlier stage detects.
    #[error(
        "the clips give a database that breaks `{invariant}`: {detail}; leave out the clip that this names, or repair it"
    )]
    InvalidDatabase {
        /// Name of the invariant in `fbcrowd validate`.
        invariant: &'static str,
        /// Where and how the invariant is broken.
        detail: String,
    },
}

impl CompileError {
    /// Whether the machine failed (disk, memory). Otherwise the clips or the manifest are wrong.
    pub fn is_of_machine(&self) -> bool {
        match self {
            Self::UnreadableFolder { source, .. } | Self::UnreadableManifest { source, .. } => {
                input_file::is_of_machine(source)
            }
            Self::ClipUnread(_) | Self::OutOfMemory { .. } => true,
            _ => false,
        }
    }
}

impl From<Invalid> for CompileError {
    fn from(invalid: Invalid) -> Self {
        Self::InvalidManifest(Box::new(invalid))
    }
}

/// What a clip of a transition shows, and what else to do.
pub(crate) fn transition_remedy(kind: ActionKind) -> String {
    let shows = match kind {
        ActionKind::Start => "the body must stand, both feet planted, and then make at least two steps",
        ActionKind::Stop => "the body must make at least two steps and then stand, both feet planted",
        ActionKind::Idle | ActionKind::Turn => "the body must stand, turn by at least 45° on the spot, and stand again",
        ActionKind::Step => "the body must stand, make one to three steps without a turn, and stand again",
        ActionKind::Pivot => "the body must walk, turn by at least 60° within 3 s, and walk on",
    };
    format!("{shows}; state another kind (start, stop, turn, step, pivot), or remove the key")
}

/// The styles that a set has, and what to do.
fn of_styles(styles: &[String]) -> String {
    match styles {
        [] => {
            "the clips have none: state `style` in a manifest.toml; folders of at least two manners side by side are \
               styles, too"
                .to_owned()
        }
        names => format!("the clips have {}", names.join(", ")),
    }
}

/// One clause for each rejection and each source.
fn reasons(rejected: &[Rejection], sources: &[SourceRecord]) -> String {
    let rejections = rejected.iter().map(Rejection::to_string);
    let records = sources.iter().map(|source| {
        let clip = if source.clip.is_empty() { String::new() } else { format!(", {}", source.clip) };
        let sentences: Vec<String> = source.diagnostics.iter().map(ToString::to_string).collect();
        format!("{}{clip}: {}", source.file, sentences.join("; "))
    });
    rejections.chain(records).collect::<Vec<String>>().join("; ")
}

//! Why clips give no database: each reason names what to do.

use motiondb::motion::SourceRecord;

use crate::input::manifest::error::ManifestError;
use crate::refused::Refused;

/// No database could be made.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// Nothing to compile.
    #[error("no clips; name *.bvh, *.glb or *.gltf files or a folder that holds some")]
    NoClips,
    /// Every clip was read, none walks or stands.
    #[error(
        "no clip gives an example: {}; give clips of steady walking, running, turning or standing",
        all(refused, sources)
    )]
    NoExample {
        /// Files and clips that are no human motion, and why.
        refused: Vec<Refused>,
        /// Clips that are, with their diagnostics.
        sources: Vec<SourceRecord>,
    },
    /// What was compiled is no sound database: the clips hold something that no earlier stage knew to refuse.
    #[error(
        "the clips give a database that breaks `{invariant}`: {detail}; leave out the clip that this names, or repair it"
    )]
    Unsound {
        /// Its name in `fbcrowd validate`.
        invariant: &'static str,
        /// Where and how.
        detail: String,
    },
    /// A manifest cannot be followed.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// The clip that was chosen as m_sp.
    #[error(
        "`{name}`: no stepping cycle found; this clip cannot be the base walk (m_sp). Choose another with \
         `semi_procedural = \"…\"`"
    )]
    NotStepping {
        /// Its name.
        name: String,
        /// Its examples that step, where another window was chosen.
        stepping: Vec<String>,
    },
}

fn all(refused: &[Refused], sources: &[SourceRecord]) -> String {
    let of_source = |source: &SourceRecord| {
        let sentences: Vec<String> = source.diagnostics.iter().map(ToString::to_string).collect();
        Refused { file: source.file.clone(), clip: source.clip.clone(), reason: sentences.join("; ") }
    };
    let all = refused.iter().cloned().chain(sources.iter().map(of_source));
    all.map(|reason| reason.to_string()).collect::<Vec<String>>().join("; ")
}

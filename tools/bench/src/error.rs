//! Why a bench cannot run: one enum, each variant with the path, the place in it and the remedy.

use std::io;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::JobError;
use rayon::ThreadPoolBuildError;

/// Why a bench cannot run.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A part of the bench fails as a job would.
    #[error(transparent)]
    Job(JobError),
    /// A file or folder cannot be read.
    #[error("{} cannot be read: {source}; check that it exists and may be read", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system starts no threads.
    #[error("cannot start {threads} threads: {source}; use fewer")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// The system's reason.
        source: ThreadPoolBuildError,
    },
    /// A folder holds no scene.
    #[error("{}: holds no scene; give a folder of `NAME_s1.txt`", folder.display())]
    NoScenes {
        /// The folder.
        folder: PathBuf,
    },
    /// No scene has a seed that was requested.
    #[error("no scene has seed {seed}; the seeds are {}", seeds.iter().map(u64::to_string).collect::<Vec<_>>().join(", "))]
    NoSuchSeed {
        /// The seed.
        seed: u64,
        /// The seeds of the scenes.
        seeds: Vec<u64>,
    },
    /// A bench has no test of a name that was requested.
    #[error("--tests: there is no test `{test}`; the tests are {tests}")]
    NoSuchTest {
        /// The name.
        test: String,
        /// The names of all tests.
        tests: String,
    },
    /// A line of labels is malformed.
    #[error("{}:{line}: not a label; write file,clip,fps,set,side,event,frame,pm", path.display())]
    Label {
        /// The file of labels.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
    },
    /// A clip with labels cannot be used.
    #[error("{}, {clip}: {reason}", path.display())]
    UnusableClip {
        /// The file.
        path: PathBuf,
        /// Name of the clip within the file.
        clip: String,
        /// What is wrong, and the remedy.
        reason: String,
    },
    /// The database has no clip for semi-procedural locomotion.
    #[error("the database has no walk ahead that could be deformed; add one")]
    NoWalk,
}

impl BenchError {
    /// The system does not allow reading `path`.
    pub(crate) fn unreadable(path: &Path, source: io::Error) -> Self {
        Self::Unreadable { path: path.to_owned(), source }
    }
}

/// Errors of the libraries fail a bench as they fail a job.
impl<E> From<E> for BenchError
where
    JobError: From<E>,
{
    fn from(error: E) -> Self {
        Self::Job(error.into())
    }
}

//! What a command answers, and how bad usage and bad input end it.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use motiondb::files::Invalid;
use motiondb::motion::SourceRecord;
use motiondb_compiler::{CompileError, Rejection};

use crate::compile_report::CompileReport;
use crate::{compile_text, output};

/// The text around a mistake is shown only where all its lines are shorter: nobody reads longer ones.
const SHOWN_LINE_BYTES: usize = 1_000;
/// Where all that was named is refused.
pub(crate) const NO_HUMAN: &str = "none of the clips can be used; give clips of a walking human skeleton";

/// The answer of a command that could do its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Exit code 0.
    Yes,
    /// Exit code 1: an invariant is broken, or some input was refused while the rest was used.
    No,
}

/// Why a command could not do its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Exit code 2, with the message.
    Bad(miette::Report),
    /// Exit code 2, with what is wrong with each clip.
    NoExample {
        /// What is no human motion.
        rejected: Vec<Rejection>,
        /// What is.
        sources: Vec<SourceRecord>,
    },
    /// Whoever read standard output has gone: nobody is left to tell.
    ReaderGone,
}

impl Failure {
    /// Bad usage or input; the message names what, where and the remedy.
    pub(crate) fn bad(message: impl Into<String>) -> Self {
        Self::Bad(Report::msg(output::one_line(&message.into())))
    }

    /// A mistake in a scenario or a manifest, shown where it stands.
    pub(crate) fn mistake(invalid: Invalid) -> Self {
        let message = format!("{}:{}: {}", invalid.path.display(), invalid.line(), invalid.message);
        let mistake = MietteDiagnostic::new(output::one_line(&message)).with_help(&invalid.help);
        if invalid.text.lines().any(|line| line.len() > SHOWN_LINE_BYTES) {
            return Self::Bad(Report::new(mistake));
        }
        let name = output::one_line(&invalid.path.display().to_string());
        let mistake = mistake.with_label(LabeledSpan::underline(invalid.span));
        Self::Bad(Report::new(mistake).with_source_code(NamedSource::new(name, shown(&invalid.text))))
    }

    /// A file or folder that the system would not let us write.
    pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Self {
        Self::bad(format!("cannot write {}: {error}; choose another place", path.display()))
    }

    /// Says it on standard error.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::Bad(report) => {
                output::say_text(&format!("Error: {report:?}"));
                ExitCode::from(2)
            }
            Self::NoExample { rejected, sources } => {
                // The reporter would wrap the list.
                let advice = match sources.is_empty() {
                    true => NO_HUMAN,
                    false => "no clip gives an example; give clips of steady walking, running, turning or standing",
                };
                output::say_text(&compile_text::reasons(&CompileReport::without_examples(rejected, &sources)));
                Self::bad(advice).report()
            }
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }
}

/// A text as it may be shown: what a terminal would obey is blotted out, at the same length in bytes.
fn shown(text: &str) -> String {
    let blotted = |letter: char| match letter {
        '\n' | '\t' => letter,
        '\r' => ' ',
        letter if !letter.is_control() => letter,
        letter if letter.is_ascii() => '?',
        _ => '·',
    };
    text.chars().map(blotted).collect()
}

impl From<motiondb::files::database_file::FileError> for Failure {
    fn from(error: motiondb::files::database_file::FileError) -> Self {
        Self::bad(error.to_string())
    }
}

impl From<CompileError> for Failure {
    fn from(error: CompileError) -> Self {
        match error {
            CompileError::InvalidManifest(invalid) => Self::mistake(*invalid),
            CompileError::NoExample { rejected, sources } => Self::NoExample { rejected, sources },
            other => Self::bad(other.to_string()),
        }
    }
}

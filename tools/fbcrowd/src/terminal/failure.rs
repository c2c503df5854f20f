//! The end of a command: its answer, or why it could not do its work, and the exit code of each.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use fbcrowd_bench::BenchError;
use fbcrowd_jobs::JobError;
use fbcrowd_render::error::RenderError;
use fbcrowd_scenes::SceneError;
use fbcrowd_sim::recording::RecordingError;
use fbcrowd_sim::scenario::ScenarioError;
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use motiondb::files::Invalid;
use motiondb::files::database_file::FileError;
use motiondb::files::input_file::is_of_machine;
use motiondb::files::temporary_files::{self, CompletedOutputs};
use motiondb::motion::SourceRecord;
use motiondb_compiler::Rejection;

use crate::report::compile_report::CompileReport;
use crate::report::compile_text;
use crate::report::next_steps::with_next_steps;
use crate::report::plain_text::one_line;
use crate::terminal::output::{self, PrintError};

/// The text around a mistake is shown only where all its lines are shorter, bytes.
const SHOWN_LINE_BYTES: usize = 1_000;
/// Where every clip that was named is rejected.
pub(crate) const ALL_REJECTED: &str = "none of the clips can be used; give clips of a walking human skeleton";

/// The answer of a command that could do its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Exit code 0.
    Yes,
    /// Exit code 1: an invariant is broken, a criterion is missed, or some input was rejected and the rest was used.
    No,
}

impl Answer {
    /// Yes where something holds.
    pub(crate) fn of(holds: bool) -> Self {
        if holds { Self::Yes } else { Self::No }
    }

    /// Yes where both are.
    pub(crate) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Yes, Self::Yes) => Self::Yes,
            _ => Self::No,
        }
    }
}

/// Exit code of bad usage or input; nothing was written.
const BAD_INPUT: u8 = 2;
/// Exit code of a failure of the machine (disk, memory, permission): a retry may help.
const MACHINE_FAILED: u8 = 3;

/// Why a command could not do its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Exit code 2: the message names what is wrong, where, and the remedy.
    BadInput(Report),
    /// Exit code 2, with what is wrong with each clip.
    NoExample {
        /// Files and clips that were rejected.
        rejected: Vec<Rejection>,
        /// Clips of human motion that give no example.
        sources: Vec<SourceRecord>,
        /// The remedy.
        advice: String,
    },
    /// Exit code 3: the system failed to write an output; the message names it.
    Machine(Report),
    /// Exit code 0: the program that read standard output has ended.
    ReaderGone,
}

impl Failure {
    /// Bad usage or input.
    pub(crate) fn bad(message: impl Into<String>) -> Self {
        Self::BadInput(Report::msg(one_line(&message.into())))
    }

    /// The machine failed: disk, memory, permission.
    pub(crate) fn of_machine(message: impl Into<String>) -> Self {
        Self::Machine(Report::msg(one_line(&message.into())))
    }

    /// A job fails.
    fn of_job(error: JobError) -> Self {
        let message = error.to_string();
        match error {
            JobError::Mistake(invalid) => Self::mistake(*invalid),
            JobError::NoExample { rejected, sources } => {
                let advice = if sources.is_empty() { ALL_REJECTED.to_owned() } else { message };
                Self::NoExample { rejected, sources, advice }
            }
            error if error.is_of_machine() => Self::of_machine(message),
            _ => Self::bad(message),
        }
    }

    /// A mistake in a scenario or a manifest, shown in the text around it.
    fn mistake(invalid: Invalid) -> Self {
        let message = format!("{}:{}: {}", invalid.path.display(), invalid.line(), invalid.message);
        let mistake = MietteDiagnostic::new(one_line(&message)).with_help(&invalid.help);
        if !invalid.is_quotable || invalid.text.lines().any(|line| line.len() > SHOWN_LINE_BYTES) {
            return Self::BadInput(Report::new(mistake));
        }
        let name = one_line(&invalid.path.display().to_string());
        let mistake = mistake.with_label(LabeledSpan::underline(invalid.span));
        Self::BadInput(Report::new(mistake).with_source_code(NamedSource::new(name, printable(&invalid.text))))
    }

    /// A file or folder that the system does not allow to write.
    pub(crate) fn unwritable(path: &Path, error: io::Error) -> Self {
        Self::of_job(JobError::unwritable(path, error))
    }

    /// Prints the reason on standard error; returns the exit code.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::BadInput(report) => {
                output::say_text(&format!("Error: {report:?}"));
                ExitCode::from(BAD_INPUT)
            }
            Self::Machine(report) => {
                output::say_text(&format!("Error: {report:?}"));
                output::say(&complete_outputs(&temporary_files::completed()));
                ExitCode::from(MACHINE_FAILED)
            }
            Self::NoExample { rejected, sources, advice } => {
                // The reporter would wrap the list.
                let report = with_next_steps(CompileReport::without_examples(rejected, &sources));
                output::say_text(&compile_text::reasons(&report));
                Self::bad(advice).report()
            }
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }
}

/// The outputs that are complete although the command failed.
fn complete_outputs(CompletedOutputs { first, count }: &CompletedOutputs) -> String {
    let paths: Vec<String> = first.iter().map(|path| path.display().to_string()).collect();
    match count - first.len() {
        _ if *count == 0 => "No output is complete.".to_owned(),
        0 => format!("Complete outputs: {}.", paths.join(", ")),
        more => format!("Complete outputs: {} and {more} more.", paths.join(", ")),
    }
}

/// A text without what a terminal would obey, at the same length in bytes.
fn printable(text: &str) -> String {
    let replaced = |letter: char| match letter {
        '\n' | '\t' => letter,
        '\r' => ' ',
        letter if !letter.is_control() => letter,
        letter if letter.is_ascii() => '?',
        _ => '·',
    };
    text.chars().map(replaced).collect()
}

impl From<PrintError> for Failure {
    fn from(error: PrintError) -> Self {
        match error {
            PrintError::ReaderGone => Self::ReaderGone,
            PrintError::Io(error) => Self::of_machine(format!("standard output cannot be written: {error}")),
        }
    }
}

impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Job(error) => Self::of_job(error),
            BenchError::Unreadable { ref source, .. } if is_of_machine(source) => Self::of_machine(error.to_string()),
            BenchError::Threads { .. } => Self::of_machine(error.to_string()),
            other => Self::bad(other.to_string()),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Mistake(invalid) => Self::mistake(*invalid),
            error if error.is_of_machine() => Self::of_machine(error.to_string()),
            other => Self::bad(other.to_string()),
        }
    }
}

/// Errors of jobs, and of the libraries, which fail a command as they fail a job.
macro_rules! fails_as_job {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::of_job(error.into())
            }
        })*
    };
}

fails_as_job!(JobError, FileError, RecordingError, RenderError, ScenarioError);

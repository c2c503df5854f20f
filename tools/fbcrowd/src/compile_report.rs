//! What `fbcrowd compile` found: the JSON that programs read, and all that its text for people is made of.
//!
//! Every clip stands in exactly one of `used` (it gives examples), `unused` (it is a human's, but gives none) and
//! `refused` (it cannot be read, or is no human's).

use std::path::Path;

use motiondb::diagnostic::{Diagnostic, Severity};
use motiondb::motion::{MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, CoverageGap};
use motiondb::quality::example_quality::{self, ExampleQuality, Finding};
use motiondb_compiler::Rejection;
use serde::Serialize;

use crate::stages::Stage;
use crate::{advice, readable};

/// Field names carry their units.
#[derive(Default, Serialize)]
pub(crate) struct CompileReport {
    /// Null where nothing was written.
    pub(crate) output: Option<String>,
    pub(crate) example_count: usize,
    pub(crate) mirror_count: usize,
    pub(crate) simplex_count: usize,
    pub(crate) refused: Vec<Reason>,
    pub(crate) unused: Vec<Reason>,
    /// Of clips that are used; sentences alone.
    warnings: Vec<Warning>,
    /// Of all clips.
    pub(crate) diagnostics: Vec<OfClip>,
    pub(crate) used: Vec<Used>,
    /// Of every example, mirrors too.
    pub(crate) quality: Vec<ExampleQuality>,
    /// What of it lies beyond its threshold; of mirrors nothing, they are as their originals are.
    pub(crate) findings: Vec<Finding>,
    pub(crate) coverage: Vec<CoverageGap>,
    pub(crate) stages: Vec<Stage>,
    pub(crate) next: Vec<String>,
}

/// A clip that gives no example, and why.
#[derive(Serialize)]
pub(crate) struct Reason {
    pub(crate) file: String,
    pub(crate) clip: String,
    pub(crate) reason: String,
}

/// The sentence of a warning or a note.
#[derive(Serialize)]
struct Warning {
    file: String,
    clip: String,
    /// Nothing to do.
    note: bool,
    text: String,
}

/// A diagnostic and its clip.
#[derive(Serialize)]
pub(crate) struct OfClip {
    pub(crate) file: String,
    pub(crate) clip: String,
    #[serde(flatten, serialize_with = "readable::serialize")]
    pub(crate) diagnostic: Diagnostic,
}

/// A clip and the examples made from it.
#[derive(Serialize)]
pub(crate) struct Used {
    pub(crate) file: String,
    pub(crate) clip: String,
    pub(crate) examples: Vec<Example>,
}

/// An example as far as it tells what became of a clip.
#[derive(Serialize)]
pub(crate) struct Example {
    pub(crate) name: String,
    pub(crate) mirrored: bool,
    pub(crate) window_s: [f32; 2],
    pub(crate) speed_mps: f32,
    pub(crate) turn_rate_rad_s: f32,
    pub(crate) strafe_mps: f32,
}

impl CompileReport {
    /// Of a database that was written to `output`, or to nowhere where a refusal is final.
    pub(crate) fn new(output: Option<&Path>, db: &MotionDb, rejected: Vec<Rejection>, stages: Vec<Stage>) -> Self {
        let mut report = Self {
            output: output.map(|path| path.display().to_string()),
            example_count: db.examples.len(),
            mirror_count: db.examples.iter().filter(|example| example.mirrored).count(),
            simplex_count: db.blend_space.simplices().filter(|corners| corners.len() > 1).count(),
            refused: rejected.into_iter().map(Reason::from).collect(),
            quality: example_quality::quality(db),
            findings: example_quality::lint(db),
            coverage: coverage::coverage(db),
            stages,
            ..Self::default()
        };
        for (index, source) in db.sources.iter().enumerate() {
            let examples: Vec<Example> =
                db.examples.iter().filter(|example| example.source as usize == index).map(Example::from).collect();
            report.add(source, examples);
        }
        report.next = advice::next(&report);
        report
    }

    /// Of clips of which none gives an example.
    pub(crate) fn without_examples(rejected: Vec<Rejection>, sources: &[SourceRecord]) -> Self {
        let refused = rejected.into_iter().map(Reason::from).collect();
        let mut report = Self { refused, ..Self::default() };
        sources.iter().for_each(|source| report.add(source, Vec::new()));
        report.next = advice::next(&report);
        report
    }

    fn add(&mut self, source: &SourceRecord, examples: Vec<Example>) {
        let (file, clip) = (source.file.clone(), source.clip.clone());
        let mut reasons = Vec::new();
        for diagnostic in &source.diagnostics {
            let (file, clip, text) = (file.clone(), clip.clone(), diagnostic.to_string());
            match diagnostic.severity() {
                Severity::NoExample => reasons.push(text),
                severity => {
                    let note = severity == Severity::Note;
                    self.warnings.push(Warning { file: file.clone(), clip: clip.clone(), note, text });
                }
            }
            self.diagnostics.push(OfClip { file, clip, diagnostic: diagnostic.clone() });
        }
        if examples.is_empty() {
            self.unused.push(Reason { file, clip, reason: reasons.join("; ") });
        } else {
            self.used.push(Used { file, clip, examples });
        }
    }

    /// The diagnostics of a severity, and their clips.
    pub(crate) fn of_severity(&self, wanted: Severity) -> impl Iterator<Item = &OfClip> {
        self.diagnostics.iter().filter(move |found| found.diagnostic.severity() == wanted)
    }
}

impl From<Rejection> for Reason {
    fn from(Rejection { file, clip, reason }: Rejection) -> Self {
        let reason = reason.to_string();
        Self { file, clip, reason }
    }
}

impl From<&MotionExample> for Example {
    fn from(example: &MotionExample) -> Self {
        Self {
            name: example.name.clone(),
            mirrored: example.mirrored,
            window_s: example.window_s,
            speed_mps: example.parameters.speed_mps,
            turn_rate_rad_s: example.parameters.turn_rate_rad_s,
            strafe_mps: example.parameters.strafe_mps,
        }
    }
}

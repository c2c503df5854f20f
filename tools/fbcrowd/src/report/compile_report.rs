//! The report of `fbcrowd compile`: its JSON, and all that its text is made of.
//!
//! Every clip is in exactly one list: `used` (it gives examples or actions), `unused` (a clip of human motion that gives
//! neither) or `refused` (it cannot be read, or shows no human).

use std::path::Path;

use fbcrowd_jobs::json_schema::motion::{ActionKindMirror, CoverageGapMirror, ExampleQualityMirror, FindingMirror};
use fbcrowd_jobs::stages::StageTime;
use motiondb::diagnostic::{Diagnostic, Severity};
use motiondb::motion::{ActionKind, MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, CoverageGap};
use motiondb::quality::example_quality::{self, ExampleQuality};
use motiondb::quality::finding::Finding;
use motiondb_compiler::Rejection;
use schemars::JsonSchema;
use serde::Serialize;

use crate::report::action_report::{self, ActionReport, action_reports};
use crate::report::json_diagnostic;

/// The result of a compilation.
#[derive(Default, JsonSchema, Serialize)]
pub(crate) struct CompileReport {
    /// Path of the database; null where nothing was written.
    pub(crate) output: Option<String>,
    /// Number of examples, mirrored ones included.
    pub(crate) example_count: usize,
    /// Number of mirrored examples.
    pub(crate) mirror_count: usize,
    /// Number of simplices of the blend space.
    pub(crate) simplex_count: usize,
    /// Files and clips that were rejected.
    pub(crate) refused: Vec<UnusedClip>,
    /// Clips of human motion that give neither examples nor actions.
    pub(crate) unused: Vec<UnusedClip>,
    /// Sentences of the notes and warnings among `diagnostics`.
    pub(crate) warnings: Vec<ClipWarning>,
    /// Diagnostics of all clips of human motion.
    pub(crate) diagnostics: Vec<ClipDiagnostic>,
    /// Clips that give examples or actions.
    pub(crate) used: Vec<UsedClip>,
    /// Idles, the best first, and transitions.
    pub(crate) actions: Vec<ActionReport>,
    /// Kinds of transitions that the set lacks; bodies do without them.
    #[schemars(with = "Vec<ActionKindMirror>")]
    pub(crate) missing_transitions: Vec<ActionKind>,
    /// Quality of the motion of every example, mirrored ones included.
    #[schemars(with = "Vec<ExampleQualityMirror>")]
    pub(crate) quality: Vec<ExampleQuality>,
    /// Quality figures beyond their threshold. Mirrored examples are left out: they are as good as their originals.
    #[schemars(with = "Vec<FindingMirror>")]
    pub(crate) findings: Vec<Finding>,
    /// Coverage gaps: regions of gaits without examples nearby.
    #[schemars(with = "Vec<CoverageGapMirror>")]
    pub(crate) coverage: Vec<CoverageGap>,
    /// Durations of the compiler's stages.
    pub(crate) stages: Vec<StageTime>,
    /// What to do next, a sentence each.
    pub(crate) next: Vec<String>,
}

/// A clip that gives no example.
#[derive(JsonSchema, Serialize)]
pub(crate) struct UnusedClip {
    /// File of the clip.
    pub(crate) file: String,
    /// Name of the clip within the file; empty for the file as a whole.
    pub(crate) clip: String,
    /// What is wrong, where, and the remedy.
    pub(crate) reason: String,
}

/// A diagnostic of a clip.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ClipDiagnostic {
    /// File of the clip.
    pub(crate) file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub(crate) clip: String,
    #[serde(flatten, serialize_with = "json_diagnostic::serialize")]
    #[schemars(with = "json_diagnostic::JsonDiagnostic")]
    pub(crate) diagnostic: Diagnostic,
}

/// The sentence of a note or a warning.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ClipWarning {
    /// File of the clip.
    file: String,
    /// Name of the clip within the file; empty where the file holds one.
    clip: String,
    /// Whether the sentence requires no action.
    note: bool,
    /// The sentence.
    text: String,
}

/// A clip that gives examples or actions.
#[derive(JsonSchema, Serialize)]
pub(crate) struct UsedClip {
    /// File of the clip.
    pub(crate) file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub(crate) clip: String,
    /// Examples made from the clip; empty where it gives actions alone.
    pub(crate) examples: Vec<ExampleReport>,
    /// Names of the actions made from the clip.
    pub(crate) actions: Vec<String>,
}

/// One example of a clip.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ExampleReport {
    /// Name of the example.
    pub(crate) name: String,
    /// Whether the motion is mirrored.
    pub(crate) mirrored: bool,
    /// Start and end of the window in the clip, s.
    pub(crate) window_s: [f32; 2],
    /// Mean speed along the facing, m/s; negative backward.
    pub(crate) speed_mps: f32,
    /// Mean turn rate, rad/s; counter-clockwise from above is positive.
    pub(crate) turn_rate_rad_s: f32,
    /// Mean speed to the left of the facing, m/s.
    pub(crate) strafe_mps: f32,
}

impl CompileReport {
    /// The report of a database, without `next`; `output` is none where it was not written.
    pub(crate) fn new(output: Option<&Path>, db: &MotionDb, rejected: Vec<Rejection>, stages: Vec<StageTime>) -> Self {
        let actions = action_reports(db);
        let mut report = Self {
            output: output.map(|path| path.display().to_string()),
            example_count: db.examples.len(),
            mirror_count: db.examples.iter().filter(|example| example.mirrored).count(),
            simplex_count: db.blend_space.simplices().filter(|corners| corners.len() > 1).count(),
            refused: rejected.into_iter().map(UnusedClip::from).collect(),
            missing_transitions: action_report::missing(&actions),
            actions,
            quality: example_quality::quality(db),
            findings: example_quality::lint(db),
            coverage: coverage::coverage(db),
            stages,
            ..Self::default()
        };
        for (index, source) in db.sources.iter().enumerate() {
            let examples = db.examples.iter().filter(|example| example.source as usize == index);
            let actions = db.actions.iter().filter(|action| action.source as usize == index);
            let names = actions.map(|action| action.name.clone()).collect();
            report.add(source, examples.map(ExampleReport::from).collect(), names);
        }
        report
    }

    /// The report of clips of which none gives an example, without `next`.
    pub(crate) fn without_examples(rejected: Vec<Rejection>, sources: &[SourceRecord]) -> Self {
        let refused = rejected.into_iter().map(UnusedClip::from).collect();
        let mut report = Self { refused, ..Self::default() };
        sources.iter().for_each(|source| report.add(source, Vec::new(), Vec::new()));
        report
    }

    /// Adds a clip of human motion.
    fn add(&mut self, source: &SourceRecord, examples: Vec<ExampleReport>, actions: Vec<String>) {
        let (file, clip) = (source.file.clone(), source.clip.clone());
        let mut reasons = Vec::new();
        for diagnostic in &source.diagnostics {
            let (file, clip, text) = (file.clone(), clip.clone(), diagnostic.to_string());
            match diagnostic.severity() {
                Severity::NoExample => reasons.push(text),
                severity => {
                    let note = severity == Severity::Note;
                    self.warnings.push(ClipWarning { file: file.clone(), clip: clip.clone(), note, text });
                }
            }
            self.diagnostics.push(ClipDiagnostic { file, clip, diagnostic: diagnostic.clone() });
        }
        if examples.is_empty() && actions.is_empty() {
            self.unused.push(UnusedClip { file, clip, reason: reasons.join("; ") });
        } else {
            self.used.push(UsedClip { file, clip, examples, actions });
        }
    }

    /// The diagnostics of a severity, and their clips.
    pub(crate) fn of_severity(&self, wanted: Severity) -> impl Iterator<Item = &ClipDiagnostic> {
        self.diagnostics.iter().filter(move |found| found.diagnostic.severity() == wanted)
    }
}

impl From<Rejection> for UnusedClip {
    fn from(Rejection { file, clip, reason }: Rejection) -> Self {
        Self { file, clip, reason: reason.to_string() }
    }
}

impl From<&MotionExample> for ExampleReport {
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

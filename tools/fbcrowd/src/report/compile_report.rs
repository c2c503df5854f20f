//! The report of `fbcrowd compile`: its JSON, and all that its text is made of.
//!
//! Every clip is in exactly one list: `used` (it gives examples or actions), `unused` (a clip of human motion that gives
//! neither) or `refused` (it cannot be read, or shows no human).

use std::collections::BTreeSet;
use std::path::Path;

use fbcrowd_jobs::json_schema::motion::{ActionKindMirror, CoverageGapMirror, ExampleQualityMirror, FindingMirror};
use fbcrowd_jobs::stages::StageTime;
use motiondb::diagnostic::{Diagnostic, Note, Severity};
use motiondb::motion::{ActionKind, MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, CoverageGap};
use motiondb::quality::example_quality::{self, ExampleQuality};
use motiondb::quality::finding::Finding;
use motiondb_compiler::Rejection;
use schemars::JsonSchema;
use serde::Serialize;

use crate::report::json_diagnostic;
use crate::report::motion::action_report::{self, ActionReport, action_reports};
use crate::report::motion::style_report::{self, StyleReport, style_reports};

/// The result of a compilation.
#[derive(Default, JsonSchema, Serialize)]
pub(crate) struct CompileReport {
    /// Path of the database; null where nothing was written.
    pub(crate) output: Option<String>,
    /// The styles of the database, the one of agents without a style first; empty where no clip has one.
    pub(crate) styles: Vec<StyleReport>,
    /// Number of examples of all styles, mirrored ones included.
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
    /// Coverage gaps of the first style: regions of gaits without examples nearby.
    #[schemars(with = "Vec<CoverageGapMirror>")]
    pub(crate) coverage: Vec<CoverageGap>,
    /// Durations of the compiler's stages.
    pub(crate) stages: Vec<StageTime>,
    /// What to do next, a sentence each.
    pub(crate) next: Vec<String>,
    /// Known manners in the names of clips without a style.
    #[serde(skip)]
    pub(crate) unstyled_manners: BTreeSet<&'static str>,
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
    /// The style of the examples; empty where they have none.
    pub(crate) style: String,
}

/// One example of a clip.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ExampleReport {
    /// Name of the example.
    pub(crate) name: String,
    /// Whether the motion is mirrored.
    pub(crate) mirrored: bool,
    /// Whether it is the base walk m_sp, which semi-procedural locomotion deforms. False where there is one example only.
    pub(crate) base_walk: bool,
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
        let mut report = Self {
            output: output.map(|path| path.display().to_string()),
            styles: style_reports(db),
            refused: rejected.into_iter().map(UnusedClip::from).collect(),
            stages,
            ..Self::default()
        };
        db.styles().for_each(|style| report.add_style(style));
        report.coverage = coverage::coverage(db);
        report.missing_transitions = action_report::missing(&report.actions);
        report
    }

    /// Adds the database of a style, without its further styles.
    fn add_style(&mut self, db: &MotionDb) {
        self.example_count += db.examples.len();
        self.mirror_count += db.examples.iter().filter(|example| example.mirrored).count();
        self.simplex_count += db.blend_space.simplices().filter(|corners| corners.len() > 1).count();
        self.quality.extend(example_quality::quality(db));
        self.findings.extend(example_quality::lint(db));
        let base_walk = db.correspondence.as_ref().map(|found| found.semi_procedural as usize);
        let own = |source: u32| style_report::lender(&db.sources[source as usize]).is_none();
        self.actions.extend(
            action_reports(db)
                .into_iter()
                .zip(&db.actions)
                .filter(|(_, action)| own(action.source))
                .map(|(report, _)| report),
        );
        for (index, source) in db.sources.iter().enumerate().filter(|(index, _)| own(*index as u32)) {
            let examples = db.examples.iter().enumerate().filter(|(_, example)| example.source as usize == index);
            let examples = examples.map(|(index, example)| ExampleReport::new(example, base_walk == Some(index)));
            let actions = db.actions.iter().filter(|action| action.source as usize == index);
            let names = actions.map(|action| action.name.clone()).collect();
            self.add(source, examples.collect(), names, &db.style);
        }
    }

    /// The report of clips of which none gives an example, without `next`.
    pub(crate) fn without_examples(rejected: Vec<Rejection>, sources: &[SourceRecord]) -> Self {
        let refused = rejected.into_iter().map(UnusedClip::from).collect();
        let mut report = Self { refused, ..Self::default() };
        sources.iter().for_each(|source| report.add(source, Vec::new(), Vec::new(), ""));
        report
    }

    /// Adds a clip of human motion.
    fn add(&mut self, source: &SourceRecord, examples: Vec<ExampleReport>, actions: Vec<String>, style: &str) {
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
            reasons.extend(all_left_out(&source.diagnostics));
            self.unused.push(UnusedClip { file, clip, reason: reasons.join("; ") });
        } else {
            self.used.push(UsedClip { file, clip, examples, actions, style: style.to_owned() });
        }
    }

    /// The diagnostics of a severity, and their clips.
    pub(crate) fn of_severity(&self, wanted: Severity) -> impl Iterator<Item = &ClipDiagnostic> {
        self.diagnostics.iter().filter(move |found| found.diagnostic.severity() == wanted)
    }
}

/// The reason why a clip gives nothing whose examples `max_examples` leaves out.
fn all_left_out(diagnostics: &[Diagnostic]) -> Option<String> {
    let mut limits = diagnostics.iter().filter_map(|diagnostic| match diagnostic {
        Diagnostic::Note(Note::ExampleLeftOut { max_examples, .. }) => Some(max_examples),
        _ => None,
    });
    limits.next().map(|max_examples| format!("left out: max_examples = {max_examples}"))
}

impl From<Rejection> for UnusedClip {
    fn from(Rejection { file, clip, reason }: Rejection) -> Self {
        Self { file, clip, reason: reason.to_string() }
    }
}

impl ExampleReport {
    fn new(example: &MotionExample, base_walk: bool) -> Self {
        Self {
            name: example.name.clone(),
            mirrored: example.mirrored,
            base_walk,
            window_s: example.window_s,
            speed_mps: example.parameters.speed_mps,
            turn_rate_rad_s: example.parameters.turn_rate_rad_s,
            strafe_mps: example.parameters.strafe_mps,
        }
    }
}

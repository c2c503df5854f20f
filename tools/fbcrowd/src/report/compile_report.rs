//! The report of `fbcrowd compile`: its JSON, and all that its text is made of.
//!
//! Every clip is in exactly one list: `used` (it gives examples), `unused` (a clip of human motion without examples) or
//! `refused` (it cannot be read, or shows no human).

use std::path::Path;

use fbcrowd_jobs::json_schema::motion::{ExampleQualityMirror, FindingMirror, ThinPlaceMirror};
use fbcrowd_jobs::stages::StageTime;
use motiondb::coverage::{self, ThinPlace};
use motiondb::motion_db::{MotionDb, MotionExample, SourceRecord};
use motiondb::quality::{self, ExampleQuality, Finding};
use motiondb::remark::{self, Kind, Weight};
use motiondb_compiler::refused::Refused;
use schemars::JsonSchema;
use serde::Serialize;

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
    /// Files and clips that were refused.
    pub(crate) refused: Vec<UnusedClip>,
    /// Clips of human motion that give no example.
    pub(crate) unused: Vec<UnusedClip>,
    /// Diagnostics of clips.
    pub(crate) warnings: Vec<ClipDiagnostic>,
    /// Clips that give examples.
    pub(crate) used: Vec<UsedClip>,
    /// Quality of the motion of every example, mirrored ones included.
    #[schemars(with = "Vec<ExampleQualityMirror>")]
    pub(crate) quality: Vec<ExampleQuality>,
    /// Quality figures beyond their threshold. Mirrored examples are left out: they are as good as their originals.
    #[schemars(with = "Vec<FindingMirror>")]
    pub(crate) findings: Vec<Finding>,
    /// Where the set of examples is thin.
    #[schemars(with = "Vec<ThinPlaceMirror>")]
    pub(crate) coverage: Vec<ThinPlace>,
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
    #[serde(skip)]
    pub(crate) kind: Kind,
    /// Whether the diagnostic asks for nothing.
    pub(crate) note: bool,
    /// The diagnostic, a sentence.
    pub(crate) text: String,
}

/// A clip that gives examples.
#[derive(JsonSchema, Serialize)]
pub(crate) struct UsedClip {
    /// File of the clip.
    pub(crate) file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub(crate) clip: String,
    /// Examples made from the clip.
    pub(crate) examples: Vec<ExampleReport>,
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
    pub(crate) fn new(output: Option<&Path>, db: &MotionDb, refused: Vec<Refused>, stages: Vec<StageTime>) -> Self {
        let mut report = Self {
            output: output.map(|path| path.display().to_string()),
            example_count: db.examples.len(),
            mirror_count: db.examples.iter().filter(|example| example.mirrored).count(),
            simplex_count: db.blend_space.simplices().filter(|corners| corners.len() > 1).count(),
            refused: refused.into_iter().map(UnusedClip::from).collect(),
            quality: quality::quality(db),
            findings: quality::lint(db),
            coverage: coverage::coverage(db),
            stages,
            ..Self::default()
        };
        for (index, source) in db.sources.iter().enumerate() {
            let of_source = db.examples.iter().filter(|example| example.source as usize == index);
            report.add(source, of_source.map(ExampleReport::from).collect());
        }
        report
    }

    /// The report of clips of which none gives an example, without `next`.
    pub(crate) fn without_examples(refused: Vec<Refused>, sources: &[SourceRecord]) -> Self {
        let refused = refused.into_iter().map(UnusedClip::from).collect();
        let mut report = Self { refused, ..Self::default() };
        sources.iter().for_each(|source| report.add(source, Vec::new()));
        report
    }

    /// Adds a clip of human motion.
    fn add(&mut self, source: &SourceRecord, examples: Vec<ExampleReport>) {
        let (file, clip) = (&source.file, &source.clip);
        let diagnostic = |remark: &remark::Remark| ClipDiagnostic {
            file: file.clone(),
            clip: clip.clone(),
            kind: remark.kind,
            note: remark.weight() == Weight::Note,
            text: remark.text.clone(),
        };
        let (reasons, remarks): (Vec<&remark::Remark>, Vec<&remark::Remark>) =
            source.warnings.iter().partition(|remark| examples.is_empty() && remark.weight() == Weight::NoExample);
        self.warnings.extend(remarks.into_iter().map(diagnostic));
        let (file, clip) = (file.clone(), clip.clone());
        if examples.is_empty() {
            let reasons: Vec<&str> = reasons.into_iter().map(|remark| remark.text.as_str()).collect();
            self.unused.push(UnusedClip { file, clip, reason: reasons.join("; ") });
        } else {
            self.used.push(UsedClip { file, clip, examples });
        }
    }
}

impl From<Refused> for UnusedClip {
    fn from(Refused { file, clip, reason }: Refused) -> Self {
        Self { file, clip, reason }
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

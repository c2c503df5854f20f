//! What `fbcrowd compile` found: the JSON that programs read, and all that its text for people is made of.
//!
//! Every clip stands in exactly one of `used` (it gives examples), `unused` (it is a human's, but gives none) and
//! `refused` (it cannot be read, or is no human's).

use std::path::Path;

use motiondb::motion::remark::{self, Kind, Weight};
use motiondb::motion::{MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, ThinPlace};
use motiondb::quality::example_quality::{self, ExampleQuality, Finding};
use motiondb_compiler::refused::Refused;
use serde::Serialize;

use crate::advice;
use crate::stages::Stage;

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
    pub(crate) warnings: Vec<Remark>,
    pub(crate) used: Vec<Used>,
    /// Of every example, mirrors too.
    pub(crate) quality: Vec<ExampleQuality>,
    /// What of it lies beyond its threshold; of mirrors nothing, they are as their originals are.
    pub(crate) findings: Vec<Finding>,
    pub(crate) coverage: Vec<ThinPlace>,
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

/// What is to be said of a clip that is used.
#[derive(Serialize)]
pub(crate) struct Remark {
    pub(crate) file: String,
    pub(crate) clip: String,
    #[serde(skip)]
    pub(crate) kind: Kind,
    /// Nothing to do.
    pub(crate) note: bool,
    pub(crate) text: String,
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
    pub(crate) fn new(output: Option<&Path>, db: &MotionDb, refused: Vec<Refused>, stages: Vec<Stage>) -> Self {
        let mut report = Self {
            output: output.map(|path| path.display().to_string()),
            example_count: db.examples.len(),
            mirror_count: db.examples.iter().filter(|example| example.mirrored).count(),
            simplex_count: db.blend_space.simplices().filter(|corners| corners.len() > 1).count(),
            refused: refused.into_iter().map(Reason::from).collect(),
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
    pub(crate) fn without_examples(refused: Vec<Refused>, sources: &[SourceRecord]) -> Self {
        let refused = refused.into_iter().map(Reason::from).collect();
        let mut report = Self { refused, ..Self::default() };
        sources.iter().for_each(|source| report.add(source, Vec::new()));
        report.next = advice::next(&report);
        report
    }

    fn add(&mut self, source: &SourceRecord, examples: Vec<Example>) {
        let (file, clip) = (&source.file, &source.clip);
        let remark = |told: &remark::Remark| Remark {
            file: file.clone(),
            clip: clip.clone(),
            kind: told.kind,
            note: told.weight() == Weight::Note,
            text: told.text.clone(),
        };
        let (reasons, remarks): (Vec<&remark::Remark>, Vec<&remark::Remark>) =
            source.warnings.iter().partition(|told| examples.is_empty() && told.weight() == Weight::NoExample);
        self.warnings.extend(remarks.into_iter().map(remark));
        let (file, clip) = (file.clone(), clip.clone());
        if examples.is_empty() {
            let reasons: Vec<&str> = reasons.into_iter().map(|told| told.text.as_str()).collect();
            self.unused.push(Reason { file, clip, reason: reasons.join("; ") });
        } else {
            self.used.push(Used { file, clip, examples });
        }
    }
}

impl From<Refused> for Reason {
    fn from(Refused { file, clip, reason }: Refused) -> Self {
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

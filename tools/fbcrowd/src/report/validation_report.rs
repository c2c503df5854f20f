//! The report of `fbcrowd validate`: every invariant of a database, and the quality of its motion.

use fbcrowd_jobs::json_schema::motion::{ExampleQualityMirror, FindingMirror};
use motiondb::motion::MotionDb;
use motiondb::quality::action_quality;
use motiondb::quality::example_quality::{self, ExampleQuality};
use motiondb::quality::finding::Finding;
use motiondb::validate::{self, Check};
use schemars::JsonSchema;
use serde::Serialize;

/// Invariants and quality of a database.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ValidationReport {
    /// Whether all invariants hold.
    pub(crate) valid: bool,
    /// The invariants.
    pub(crate) checks: Vec<InvariantCheck>,
    /// Quality figures of examples and actions beyond their threshold; empty where an invariant is broken. Mirrored
    /// ones are left out.
    #[schemars(with = "Vec<FindingMirror>")]
    pub(crate) findings: Vec<Finding>,
    /// Quality figures of every example, mirrored ones included; empty where an invariant is broken.
    #[schemars(with = "Vec<ExampleQualityMirror>")]
    pub(crate) quality: Vec<ExampleQuality>,
}

/// One invariant.
#[derive(JsonSchema, Serialize)]
pub(crate) struct InvariantCheck {
    /// Name of the invariant.
    pub(crate) name: &'static str,
    /// Whether it holds.
    pub(crate) holds: bool,
    /// Where and how it is broken; null where it holds.
    pub(crate) detail: Option<String>,
}

impl ValidationReport {
    /// The report of a database whose file could be read.
    pub(crate) fn new(db: &MotionDb) -> Self {
        // A file that can be read has the right mark, version, length and checksum.
        let checksum = Check { name: "checksum", broken: None };
        let checks: Vec<InvariantCheck> =
            [checksum].into_iter().chain(validate::validate(db)).map(InvariantCheck::from).collect();
        let valid = checks.iter().all(|check| check.holds);
        // Figures of an unsound database mean nothing.
        let (findings, quality) = if valid {
            (db.styles().flat_map(lint).collect(), db.styles().flat_map(example_quality::quality).collect())
        } else {
            Default::default()
        };
        Self { valid, checks, findings, quality }
    }

    /// One invariant or finding a line.
    pub(crate) fn text(&self) -> String {
        let check = |check: &InvariantCheck| match &check.detail {
            None => format!("holds    {}\n", check.name),
            Some(detail) => format!("BROKEN   {}: {detail}\n", check.name),
        };
        let finding = |finding: &Finding| format!("warning  {}: {}\n", finding.example, finding.sentence);
        self.checks.iter().map(check).chain(self.findings.iter().map(finding)).collect()
    }
}

/// Findings about examples, then about actions.
fn lint(db: &MotionDb) -> Vec<Finding> {
    example_quality::lint(db).into_iter().chain(action_quality::lint(db)).collect()
}

impl From<Check> for InvariantCheck {
    fn from(check: Check) -> Self {
        Self { name: check.name, holds: check.broken.is_none(), detail: check.broken }
    }
}

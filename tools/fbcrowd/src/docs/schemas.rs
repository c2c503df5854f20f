//! The schema of every JSON output.

use fbcrowd_bench::Bench;
use fbcrowd_jobs::json_schema::document;
use fbcrowd_jobs::json_schema::measures::MeasuresMirror;
use fbcrowd_jobs::json_schema::people::PeopleMeasuresMirror;
use fbcrowd_jobs::scene_check::SceneFigures;
use fbcrowd_jobs::timings::Timings;
use schemars::JsonSchema;
use serde_json::Value;

use crate::report::character_report::CharacterInspection;
use crate::report::compile_report::CompileReport;
use crate::report::inspect_report::{BrokenReport, ClipsReport, DatabaseReport};
use crate::report::scenes::ConvertReport;
use crate::report::validation_report::ValidationReport;

/// The schema of one JSON output.
pub(super) struct OutputSchema {
    /// Name of the file without its extension.
    pub(super) name: String,
    pub(super) content: Value,
}

/// One of the four reports of `fbcrowd inspect`.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only its schema is used")]
enum InspectReport {
    /// A database.
    Database(Box<DatabaseReport>),
    /// A database that breaks an invariant.
    Broken(BrokenReport),
    /// Clips.
    Clips(ClipsReport),
    /// A character.
    Character(CharacterInspection),
}

/// All schemas, in the order of the documentation.
pub(super) fn schemas() -> Vec<OutputSchema> {
    let of_commands = [
        ("compile", document::<CompileReport>("fbcrowd compile --json")),
        ("validate", document::<ValidationReport>("fbcrowd validate --json")),
        ("inspect", document::<InspectReport>("fbcrowd inspect --json")),
        ("check", document::<SceneFigures>("fbcrowd check --json")),
        ("convert", document::<ConvertReport>("fbcrowd convert --json")),
        ("simulate", document::<Timings>("fbcrowd simulate --report")),
        ("measure", document::<MeasuresMirror>("fbcrowd measure --json")),
        ("measure-people", document::<PeopleMeasuresMirror>("fbcrowd measure --people --json")),
    ];
    let of_commands = of_commands.into_iter().map(|(name, content)| (name.to_owned(), content));
    let of_benches = Bench::schemas().into_iter().map(|(name, content)| (format!("bench-{name}"), content));
    of_commands.chain(of_benches).map(|(name, content)| OutputSchema { name, content }).collect()
}

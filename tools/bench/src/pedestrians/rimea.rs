//! `fbcrowd bench rimea`: the tests of the RiMEA guideline for evacuation analyses that concern walking on level
//! ground, and three like them, each a scenario file of `assets/scenarios`, through full bodies.
//!
//! The measures and criteria of each test are in [`crate::pedestrians::guideline_cases`].

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PlotsArg};
use crate::kit::database::database;
use crate::kit::report::BenchReport;
use crate::kit::scenario_run::{ScenarioRun, draw_paths, run_scenarios, scenario, turned};
use crate::pedestrians::case::CaseFigure;
use crate::pedestrians::fundamental_diagram::{self, DIAGRAM_SCENARIO, DiagramPoint, diagram_points};
use crate::pedestrians::guideline_cases::CASES;

/// Simulate the RiMEA guideline's tests of walking: speed, density, corners, bottlenecks, and three like them.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench rimea --plots out/plots")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    #[command(flatten)]
    plots: PlotsArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// The tests, those of the guideline first.
    pub tests: Vec<CaseReport>,
    /// Points of test 4.
    pub fundamental_diagram: Vec<DiagramPoint>,
}

/// One test.
#[derive(JsonSchema, Serialize)]
pub struct CaseReport {
    /// Name of the test.
    pub test: &'static str,
    /// Path of the scenario, relative to `assets/scenarios`.
    pub scenario: &'static str,
    /// The criterion in words.
    pub criterion: &'static str,
    /// Measures of the test.
    pub figures: Vec<CaseFigure>,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or a picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    args.database.check_folder(args.plots.plots.as_ref())?;
    let db = Arc::new(database(&args.database)?);
    let mut scenarios = Vec::new();
    for case in &CASES {
        let scenario = scenario(case.file)?;
        scenarios.extend(case.turned_deg.iter().map(|turn_deg| turned(&scenario, turn_deg.to_radians())));
    }
    let runs = run_scenarios(&db, scenarios, observer)?;
    let diagram_run = runs.iter().find(|run| run.scenario.name == DIAGRAM_SCENARIO);
    let fundamental_diagram = diagram_run.map(diagram_points).unwrap_or_default();
    if let Some(folder) = &args.plots.plots {
        draw(folder, &db, &runs)?;
        fundamental_diagram::draw(&folder.join("fundamental_diagram.png"), &fundamental_diagram)?;
    }
    let (mut tests, mut criteria, mut rest) = (Vec::new(), Vec::new(), &runs[..]);
    for case in &CASES {
        let (of_case, others) = rest.split_at(case.turned_deg.len());
        rest = others;
        let outcome = (case.judge)(of_case);
        let (test, scenario, criterion) = (case.test, case.file.0, case.criterion);
        tests.push(CaseReport { test, scenario, criterion, figures: outcome.figures });
        criteria.extend(outcome.criteria);
    }
    let text = tests.iter().map(CaseReport::text).collect();
    Ok(BenchReport { details: Details { tests, fundamental_diagram }, goals: Vec::new(), criteria, text })
}

impl CaseReport {
    fn text(&self) -> String {
        let mut text = format!("{} ({})\n  {}\n", self.test, self.scenario, self.criterion);
        for CaseFigure { name, value } in &self.figures {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {value:>10.3}  {name}");
        }
        text + "\n"
    }
}

/// Draws the paths of every scenario; of turned ones only the first.
fn draw(folder: &Path, db: &MotionDb, runs: &[ScenarioRun]) -> Result<(), BenchError> {
    for (index, run) in runs.iter().enumerate() {
        let is_again = index > 0 && runs[index - 1].scenario.name == run.scenario.name;
        if !is_again {
            draw_paths(&folder.join(format!("{}.png", run.scenario.name)), db, run)?;
        }
    }
    Ok(())
}

//! `fbcrowd bench rimea`: the tests of the RiMEA guideline for evacuation analyses that concern level ground, and three
//! like them, through full bodies. Their scenarios are files of `assets/scenarios/rimea`, but for the rings of test 16.
//!
//! [`crate::pedestrians::guideline_cases`] lists the tests with their criteria.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::scenario::Scenario;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PlotsArg};
use crate::kit::database::database;
use crate::kit::report::BenchReport;
use crate::kit::scenario_run::{ScenarioRun, draw_paths, run_scenarios};
use crate::pedestrians::case::{CaseFigure, CrowdCase};
use crate::pedestrians::fundamental_diagram::{self, DIAGRAM_SCENARIO, DiagramPoint, diagram_points};
use crate::pedestrians::guideline_cases::{CASES, LEFT_OUT};

/// Simulate the RiMEA guideline's tests on level ground: speed, density, corners, exits, passages, and three like them.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench rimea --plots out/plots\n  fbcrowd bench rimea --tests 1,6,12")]
pub struct Args {
    /// Tests to run, by their number, or overtaking, queue, turned; default: all.
    #[arg(long, value_name = "TEST,TEST", value_delimiter = ',')]
    tests: Vec<String>,
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
    /// Tests of the guideline that are left out, and why.
    pub left_out: &'static str,
}

/// One test.
#[derive(JsonSchema, Serialize)]
pub struct CaseReport {
    /// Name of the test.
    pub test: &'static str,
    /// Names of the scenarios.
    pub scenarios: Vec<String>,
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
    let cases = chosen(&args.tests)?;
    let db = Arc::new(database(&args.database)?);
    let of_cases = cases.iter().map(|case| (case.scenarios)()).collect::<Result<Vec<Vec<Scenario>>, BenchError>>()?;
    let counts: Vec<usize> = of_cases.iter().map(Vec::len).collect();
    let runs = run_scenarios(&db, of_cases.into_iter().flatten().collect(), observer)?;
    let diagram_run = runs.iter().find(|run| run.scenario.name == DIAGRAM_SCENARIO);
    let fundamental_diagram = diagram_run.map(diagram_points).unwrap_or_default();
    if let Some(folder) = &args.plots.plots {
        draw(folder, &db, &runs)?;
        if diagram_run.is_some() {
            fundamental_diagram::draw(&folder.join("fundamental_diagram.png"), &fundamental_diagram)?;
        }
    }
    let (mut tests, mut criteria, mut rest) = (Vec::new(), Vec::new(), &runs[..]);
    for (case, count) in cases.iter().zip(counts) {
        let (of_case, others) = rest.split_at(count);
        rest = others;
        let outcome = (case.judge)(of_case);
        let mut scenarios: Vec<String> = of_case.iter().map(|run| run.scenario.name.clone()).collect();
        scenarios.dedup();
        tests.push(CaseReport { test: case.test, scenarios, criterion: case.criterion, figures: outcome.figures });
        criteria.extend(outcome.criteria);
    }
    let text: String = tests.iter().map(CaseReport::text).collect();
    let details = Details { tests, fundamental_diagram, left_out: LEFT_OUT };
    Ok(BenchReport { details, goals: Vec::new(), criteria, text: format!("{text}{LEFT_OUT}\n\n") })
}

/// The cases with these keys; all where there are none.
fn chosen(keys: &[String]) -> Result<Vec<&'static CrowdCase>, BenchError> {
    if let Some(test) = keys.iter().find(|key| CASES.iter().all(|case| case.key != key.as_str())) {
        let tests: Vec<&str> = CASES.iter().map(|case| case.key).collect();
        return Err(BenchError::NoSuchTest { test: test.clone(), tests: tests.join(", ") });
    }
    Ok(CASES.iter().filter(|case| keys.is_empty() || keys.iter().any(|key| key == case.key)).collect())
}

impl CaseReport {
    fn text(&self) -> String {
        let mut text = format!("{} ({})\n  {}\n", self.test, self.scenarios.join(", "), self.criterion);
        for CaseFigure { name, value } in &self.figures {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {value:>10.3}  {name}");
        }
        text + "\n"
    }
}

/// Draws the paths of every scenario; of turned ones and of several seeds only the first.
fn draw(folder: &Path, db: &MotionDb, runs: &[ScenarioRun]) -> Result<(), BenchError> {
    for (index, run) in runs.iter().enumerate() {
        let is_again = index > 0 && runs[index - 1].scenario.name == run.scenario.name;
        if !is_again {
            draw_paths(&folder.join(format!("{}.png", run.scenario.name)), db, run)?;
        }
    }
    Ok(())
}

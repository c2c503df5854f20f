//! `fbcrowd bench people`: whether bodies move as people do, and differ as people do.
//!
//! Crowds, lanes, turns and gaps ([`crate::people::people_scenes`]) at 60 steps a second, with the bundled clips (or
//! `--db`) and, with `--mocap`, with the Marine set; beside them the range of captures, measured by the same code. The
//! criteria are what a release must reach; docs/measures.md defines the measures.

use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::json_schema::people::PeopleMeasuresMirror;
use fbcrowd_sim::measures::people::{PeopleMeasures, PeopleTally, SoleSlide};
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::variation::Variation;
use motiondb::motion::MotionDb;
use motiondb::statistics::{median, percentile};
use motiondb_compiler::compile_files;
use schemars::JsonSchema;
use serde::Serialize;

use crate::compiler::ground_truth::marine_files;
use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::report::{BenchReport, Criterion};
use crate::people::captures::captures;
use crate::people::people_rows::{PeopleRow, ROWS};
use crate::people::people_scenes::{self, PeopleRuns};

/// Measure whether bodies move as people do, and differ as people do; with --mocap beside captures of people.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench people\n  fbcrowd bench people --mocap my/mocap --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    /// Folder of captures; its folder `smartbody_converted` gives a second database.
    #[arg(long, value_name = "DIR")]
    mocap: Option<PathBuf>,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Names of the databases.
    pub databases: Vec<String>,
    /// Number of captures; 0 without `--mocap`.
    pub captures: usize,
    /// Duration of all captures, minutes.
    pub capture_minutes: f64,
    /// The measures, in the order of the table.
    pub rows: Vec<MeasuredRow>,
    /// The crowds of each database.
    pub crowds: Vec<MeasuredCrowd>,
}

/// One measure.
#[derive(JsonSchema, Serialize)]
pub struct MeasuredRow {
    /// What is measured, and its unit.
    pub name: &'static str,
    /// The measure with each database; null where nothing could be measured.
    pub measured: Vec<Option<f64>>,
    /// The measure of captures; null where none shows it.
    pub captures: Option<CaptureRange>,
    /// What a release must reach; empty where the measure has no criterion.
    pub goal: String,
}

/// The range of a measure over captures.
#[derive(JsonSchema, Serialize)]
pub struct CaptureRange {
    /// Number of captures that show it.
    pub count: usize,
    /// The measure of all captures together.
    pub together: Option<f64>,
    /// Tenth percentile over captures.
    pub low: f64,
    /// Median over captures.
    pub median: f64,
    /// Ninetieth percentile over captures.
    pub high: f64,
}

/// One crowd with one database.
#[derive(JsonSchema, Serialize)]
pub struct MeasuredCrowd {
    /// Name of the database.
    pub database: String,
    /// Name of the scene.
    pub scene: String,
    /// Measures of people.
    #[schemars(with = "PeopleMeasuresMirror")]
    pub people: PeopleMeasures,
}

/// Runs the bench.
///
/// # Errors
/// If the database or the captures cannot be read, or the Marine set gives no database.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let mut databases: Vec<(String, Arc<MotionDb>)> = Vec::new();
    let name = if args.database.database.is_some() { "given" } else { "bundled" };
    databases.push((name.to_owned(), Arc::new(database(&args.database)?)));
    let mut of_captures = Vec::new();
    if let Some(mocap) = &args.mocap {
        databases.push(("Marine".to_owned(), Arc::new(compile_files(&marine_files(mocap), &|_| ())?.db)));
        of_captures = captures(mocap)?;
    }
    let runs = databases.iter().map(|(_, db)| people_scenes::run(db, vary, observer));
    let runs = runs.collect::<Result<Vec<PeopleRuns>, BenchError>>()?;
    let names: Vec<String> = databases.into_iter().map(|(name, _)| name).collect();
    let measured = |tracks: &[_]| {
        let mut tally = PeopleTally::default();
        tracks.iter().for_each(|track| tally.add(track));
        tally.finish(SoleSlide::default())
    };
    let each: Vec<PeopleMeasures> = of_captures.iter().map(|track| measured(std::slice::from_ref(track))).collect();
    let together = measured(&of_captures);
    let rows = ROWS.iter().map(|row| measured_row(row, &runs, &each, &together)).collect();
    let details = Details {
        captures: each.len(),
        capture_minutes: together.agent_minutes,
        rows,
        crowds: measured_crowds(&names, &runs),
        databases: names,
    };
    Ok(BenchReport { text: text(&details), criteria: criteria(&details), details, goals: Vec::new() })
}

/// Bodies differ, as those of a scenario file do.
fn vary(scenario: &mut Scenario) {
    scenario.variation = Some(Variation::default());
}

fn measured_row(
    row: &PeopleRow,
    runs: &[PeopleRuns],
    each: &[PeopleMeasures],
    together: &PeopleMeasures,
) -> MeasuredRow {
    let range = |of: fn(&PeopleMeasures) -> Option<f64>| {
        let values: Vec<f64> = each.iter().filter_map(of).collect();
        let share = |share: f64| percentile(values.iter().copied(), share);
        Some(CaptureRange {
            count: values.len(),
            together: of(together),
            low: share(0.1)?,
            median: median(values.iter().copied())?,
            high: share(0.9)?,
        })
    };
    MeasuredRow {
        name: row.name,
        measured: runs.iter().map(row.of_runs).collect(),
        captures: row.of_captures.and_then(range),
        goal: row.limits.text(),
    }
}

fn measured_crowds(names: &[String], runs: &[PeopleRuns]) -> Vec<MeasuredCrowd> {
    let of_database = |(name, runs): (&String, &PeopleRuns)| {
        let crowd = |run: &people_scenes::CrowdRun| MeasuredCrowd {
            database: name.clone(),
            scene: run.name.clone(),
            people: run.people.clone(),
        };
        runs.crowds.iter().map(crowd).collect::<Vec<MeasuredCrowd>>()
    };
    names.iter().zip(runs).flat_map(of_database).collect()
}

/// The criteria of every database.
fn criteria(details: &Details) -> Vec<Criterion> {
    let of_database = |(index, name): (usize, &String)| {
        let rows = ROWS.iter().zip(&details.rows);
        rows.flat_map(|(row, found)| row.criteria(name, found.measured[index])).collect::<Vec<Criterion>>()
    };
    details.databases.iter().enumerate().flat_map(of_database).collect()
}

fn text(details: &Details) -> String {
    let cell = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"));
    let mut text = format!("{:<54}", "at 60 steps a second");
    details.databases.iter().for_each(|name| text += &format!("{name:>10}"));
    text += &format!("{:>36}   must be\n", format!("{} captures (10–90 %)", details.captures));
    for row in &details.rows {
        text += &format!("{:<54}", row.name);
        row.measured.iter().for_each(|measured| text += &format!("{:>10}", cell(*measured)));
        let range = row.captures.as_ref().map(|CaptureRange { count, together, low, high, .. }| {
            format!("{} ({low:.3}–{high:.3}, n = {count})", cell(*together))
        });
        text += &format!("{:>36}   {}\n", range.unwrap_or_default(), row.goal);
    }
    text += &format!(
        "\n{:<10}{:<14}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
        "database", "scene", "minutes", "lurches", "shanks", "sudden", "to & fro", "head", "backward"
    );
    for MeasuredCrowd { database, scene, people } in &details.crowds {
        let cells = [
            Some(people.agent_minutes),
            people.pelvis_lurches.per_minute,
            people.shank_gaps.per_minute,
            people.turning.sudden_per_minute,
            people.turning.to_and_fro_per_minute,
            people.turning.fast_head_per_minute,
            people.queues.backward_share,
        ];
        text += &format!("{database:<10}{scene:<14}");
        cells.into_iter().for_each(|value| text += &format!("{:>10}", cell(value)));
        text += "\n";
    }
    text + "\n"
}

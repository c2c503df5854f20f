//! `fbcrowd bench coupled`: two-way coupling against its baseline, on the scenes of the paper's user study (§7).
//!
//! Coupled: MCN, hybrid synthesis, discs that follow their bodies. Decoupled: ORCA plans for discs alone, and blended
//! bodies follow them exactly (`coupling::decoupled`). Both use the same clips, scenes and film time step, until all
//! agents are at their goals. The study asked 21 people about naturalness, collisions and artefacts; here these are the
//! overlap of bodies, the slide of planted feet, the acceleration of the root, and the angle between facing and travel.

use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::measures::Measures;
use fbcrowd_sim::scenario::Coupling;
use fbcrowd_sim::synthesis::Modes;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, SeedsArg};
use crate::kit::database::database;
use crate::kit::planner_comparison::{ComparisonRun, MCN, ORCA, Protocol, compare};
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::scenes::{self, Scene};
use crate::kit::statistics::{Spread, spread};

/// A film's time step, s: at 0.1 s a contact would have five frames.
const DT_S: f32 = 1.0 / 30.0;

/// Compare coupled bodies with bodies that follow paths planned before, on the scenes of the paper's user study.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench coupled\n  fbcrowd bench coupled --db motion.fbdb --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    #[command(flatten)]
    seeds: SeedsArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Scenes of the user study.
    pub scenes: Vec<SceneFigures>,
}

/// Measures of one scene.
#[derive(JsonSchema, Serialize)]
pub struct SceneFigures {
    /// Name of the scene.
    pub scene: String,
    /// Number of agents.
    pub agents: usize,
    /// Measures with coupling and without it.
    pub figures: Vec<Figure>,
}

/// One measure of one scene, with coupling and without it.
#[derive(JsonSchema, Serialize)]
pub struct Figure {
    /// Name of the measure, with its unit.
    pub figure: &'static str,
    /// Mean and standard deviation over the seeds with coupling; null where nothing could be measured.
    pub coupled: Option<Spread>,
    /// Mean and standard deviation over the seeds without coupling; null where nothing could be measured.
    pub decoupled: Option<Spread>,
    /// Whether the coupled value must be below the decoupled one.
    #[serde(skip)]
    has_criterion: bool,
}

/// One measure of a run.
struct MeasuredFigure {
    name: &'static str,
    has_criterion: bool,
    of: fn(&Measures) -> Option<f64>,
}

/// A measure that the coupled bodies must have less of.
const fn less(name: &'static str, of: fn(&Measures) -> Option<f64>) -> MeasuredFigure {
    MeasuredFigure { name, has_criterion: true, of }
}

/// A measure without criterion.
const fn shown(name: &'static str, of: fn(&Measures) -> Option<f64>) -> MeasuredFigure {
    MeasuredFigure { name, has_criterion: false, of }
}

/// The measures in the order of the table.
const FIGURES: [MeasuredFigure; 11] = [
    less("bodies in each other, mm", |measures| Some(measures.body_penetration_mm)),
    shown("greatest, mm", |measures| Some(measures.body_penetration_max_mm)),
    less("slide of planted feet, cm/s", |measures| measures.planted_slide_cm_s),
    shown("share of feet planted", |measures| Some(measures.planted_share)),
    less("acceleration, m/s²", |measures| Some(measures.mean_acceleration_before_arrival_mps2)),
    less("facing off the travel, °", |measures| Some(measures.heading_error_deg)),
    shown("with side-steps and steps back, °", |measures| Some(measures.walking_heading_error_deg)),
    shown("collisions of discs C", |measures| Some(measures.collision_rate)),
    shown("share that arrives", |measures| Some(measures.arrived as f64 / measures.agents as f64)),
    shown("mean time to goal, s", |measures| measures.mean_time_to_goal_s),
    shown("strafing", |measures| Some(measures.strafing_share + measures.stepping_back_share)),
];

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or no scene has a seed that is given.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = Arc::new(database(&args.database)?);
    let scenes = scenes::study(&args.seeds.seeds)?;
    let protocol = Protocol { dt_s: DT_S, until_all_are_at_goals: true, ..Protocol::default() };
    let coupled = compare(&db, &scenes, &[MCN], &protocol, observer)?;
    let protocol = Protocol { coupling: Coupling::Decoupled, modes: Modes::Blending, ..protocol };
    let decoupled = compare(&db, &scenes, &[ORCA], &protocol, observer)?;
    let details = Details { scenes: scene_figures(&scenes, &coupled, &decoupled) };
    let criteria = details.scenes.iter().flat_map(criteria).collect();
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// Measures of each scene. Runs come by scene; those of scenes with one name are averaged.
fn scene_figures(scenes: &[Scene], coupled: &[ComparisonRun], decoupled: &[ComparisonRun]) -> Vec<SceneFigures> {
    let has_same_name = |scene: &Scene, other: &Scene| scene.name == other.name;
    let mut first = 0;
    let of_name = |scenes: &[Scene]| {
        let range = first..first + scenes.len();
        first = range.end;
        let figure = |measured: &MeasuredFigure| {
            let over = |runs: &[ComparisonRun]| {
                let values: Vec<f64> = runs.iter().filter_map(|run| (measured.of)(&run.measures)).collect();
                spread(values.into_iter())
            };
            let [coupled, decoupled] = [&coupled[range.clone()], &decoupled[range.clone()]].map(over);
            Figure { figure: measured.name, coupled, decoupled, has_criterion: measured.has_criterion }
        };
        SceneFigures {
            scene: scenes[0].name.clone(),
            agents: scenes[0].agents.len(),
            figures: FIGURES.iter().map(figure).collect(),
        }
    };
    scenes.chunk_by(has_same_name).map(of_name).collect()
}

fn criteria(scene: &SceneFigures) -> Vec<Criterion> {
    let mean = |spread: &Option<Spread>| spread.as_ref().map(|spread| spread.mean);
    let with_criterion = scene.figures.iter().filter(|figure| figure.has_criterion);
    let criterion = |figure: &Figure| {
        let limit = mean(&figure.decoupled).unwrap_or(f64::NAN);
        let name = format!("{}: {}, below the decoupled", scene.scene, figure.figure);
        Criterion::below(name, limit, mean(&figure.coupled))
    };
    with_criterion.map(criterion).collect()
}

fn text(details: &Details) -> String {
    details.scenes.iter().map(table).collect()
}

fn table(scene: &SceneFigures) -> String {
    let head =
        format!("{:<36}{:>22}{:>22}\n", format!("{}, {} agents", scene.scene, scene.agents), "coupled", "decoupled");
    let cell = |spread: &Option<Spread>| {
        let cell = |Spread { mean, deviation }: &Spread| format!("{mean:.4} ± {deviation:.4}");
        spread.as_ref().map_or_else(|| "–".to_owned(), cell)
    };
    let line = |figure: &Figure| {
        format!("{:<36}{:>22}{:>22}\n", figure.figure, cell(&figure.coupled), cell(&figure.decoupled))
    };
    head + &scene.figures.iter().map(line).collect::<String>() + "\n"
}

//! `fbcrowd bench coupled`: what the coupling is good for, on the scenes of the paper's user study (§7).
//!
//! Coupled: MCN, hybrid synthesis, discs that follow their bodies. Decoupled: ORCA plans for discs alone, and blended
//! bodies follow them exactly ([`fbcrowd_sim::coupling`]). The same clips and scenes, steps of 1/30 s as in a film,
//! until all are at their goals. The study asked 21 people for naturalness, collisions and artefacts; here these are
//! the bodies' overlap, the slide of planted feet, the acceleration of the root, and how far people face away from
//! where they go.

use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_sim::measures::Measures;
use fbcrowd_sim::scenario::Coupling;
use fbcrowd_sim::synthesis::Modes;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::contest::{MCN, ORCA, Protocol, Run, run_all};
use crate::cmd::bench::scenes::{self, Scene};
use crate::failure::{Answer, Failure};
use crate::statistics::{Spread, spread};

/// A film's step, s: at 0.1 s a contact would have five frames.
const DT_S: f32 = 1.0 / 30.0;

/// Compare coupled bodies with bodies that follow paths planned before, on the scenes of the paper's user study.
///
/// In JSON `scenes[] {scene, agents, figures[] {figure, coupled {mean, deviation}, decoupled}}` over seeds 1 to 5.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench coupled\n  fbcrowd bench coupled --db motion.fbdb --json")]
pub(super) struct Args {
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Only these seeds.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    seeds: Vec<u64>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    scenes: Vec<SceneFigures>,
}

#[derive(Serialize)]
struct SceneFigures {
    scene: String,
    agents: usize,
    figures: Vec<Figure>,
}

/// One figure of one scene, over the seeds.
#[derive(Serialize)]
struct Figure {
    figure: &'static str,
    /// Null where there was nothing to measure.
    coupled: Option<Spread>,
    decoupled: Option<Spread>,
    /// That the coupled figure shall be below the decoupled one.
    #[serde(skip)]
    is_contested: bool,
}

/// Of a run: its name, whether less of it is better and asked for, and where it stands.
type Kind = (&'static str, bool, fn(&Measures) -> Option<f64>);

const KINDS: [Kind; 11] = [
    ("bodies in each other, mm", true, |found| Some(found.body_penetration_mm)),
    ("greatest, mm", false, |found| Some(found.body_penetration_max_mm)),
    ("slide of planted feet, cm/s", true, |found| found.planted_slide_cm_s),
    ("share of feet planted", false, |found| Some(found.planted_share)),
    ("acceleration, m/s²", true, |found| Some(found.mean_acceleration_before_arrival_mps2)),
    ("facing off the travel, °", true, |found| Some(found.heading_error_deg)),
    ("with side-steps and steps back, °", false, |found| Some(found.walking_heading_error_deg)),
    ("collisions of discs C", false, |found| Some(found.collision_rate)),
    ("share that arrives", false, |found| Some(found.arrived as f64 / found.agents as f64)),
    ("mean time to goal, s", false, |found| found.mean_time_to_goal_s),
    ("strafing", false, |found| Some(found.strafing_share + found.stepping_back_share)),
];

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let scenes = scenes::study(&args.seeds)?;
    let protocol = Protocol { dt_s: DT_S, until_all_are_at_goals: true, ..Protocol::default() };
    let coupled = run_all(&db, &scenes, &[MCN], &protocol)?;
    let protocol = Protocol { coupling: Coupling::Decoupled, modes: Modes::Blending, ..protocol };
    let decoupled = run_all(&db, &scenes, &[ORCA], &protocol)?;
    let details = Details { scenes: scene_figures(&scenes, &coupled, &decoupled) };
    let bars = details.scenes.iter().flat_map(bars).collect();
    let text = text(&details);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

/// Runs of both come by scene; those of one name are averaged.
fn scene_figures(scenes: &[Scene], coupled: &[Run], decoupled: &[Run]) -> Vec<SceneFigures> {
    let by_name = |scene: &Scene, other: &Scene| scene.name == other.name;
    let mut first = 0;
    let of_name = |scenes: &[Scene]| {
        let range = first..first + scenes.len();
        first = range.end;
        let figure = |&(figure, is_contested, value): &Kind| {
            let over = |runs: &[Run]| {
                let values: Vec<f64> = runs.iter().filter_map(|run| value(&run.measures)).collect();
                spread(values.into_iter())
            };
            let [coupled, decoupled] = [&coupled[range.clone()], &decoupled[range.clone()]].map(over);
            Figure { figure, coupled, decoupled, is_contested }
        };
        SceneFigures {
            scene: scenes[0].name.clone(),
            agents: scenes[0].agents.len(),
            figures: KINDS.iter().map(figure).collect(),
        }
    };
    scenes.chunk_by(by_name).map(of_name).collect()
}

fn bars(scene: &SceneFigures) -> Vec<Bar> {
    let mean = |spread: &Option<Spread>| spread.as_ref().map(|spread| spread.mean);
    let contested = scene.figures.iter().filter(|figure| figure.is_contested);
    let bar = |figure: &Figure| {
        let limit = mean(&figure.decoupled).unwrap_or(f64::NAN);
        Bar::below(format!("{}: {}, below the decoupled", scene.scene, figure.figure), limit, mean(&figure.coupled))
    };
    contested.map(bar).collect()
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

//! `fbcrowd bench table1`: MCN against its two rivals through the same bodies, the paper's Table 1 (§7, App. 11).
//!
//! Protocol: 60 s in steps of 0.1 s for all, one set of tunables for all scenes, the same blending synthesis, figures
//! of the synthesised roots, means over seeds. The bars are MCN's: C below both rivals', its acceleration before
//! arrival too, everybody arrives, nobody stalls, and in time.

use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_sim::measures::Measures;
use fbcrowd_sim::synthesis::Modes;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::contest::{Contestant, MCN, ORCA, Protocol, Run, SOCIAL_FORCE, SOCIAL_FORCE_20, run_all};
use crate::cmd::bench::scenes::{self, Scene};
use crate::cmd::bench::{table1_discs, table1_plots, table1_text};
use crate::failure::{Answer, Failure};
use crate::statistics::{Spread, spread};

pub(super) const CONTESTANTS: [Contestant; 4] = [MCN, ORCA, SOCIAL_FORCE, SOCIAL_FORCE_20];
/// MCN's mean time to goal over ORCA's, at most.
const TIME_TO_GOAL_RATIO: f64 = 1.1;
/// What planning shall take on a quiet core, µs an agent and step: about what RVO2 takes, neighbour query included.
const PLAN_GOAL_US: f64 = 1.5;

/// Run MCN, ORCA and social forces through the same bodies, as the paper's Table 1 does.
///
/// In JSON `scenes[] {scene, agents, planners[] {planner, collision_rate, mean_acceleration_mps2,
/// mean_acceleration_before_arrival_mps2, arrived_share, stalled, mean_time_to_goal_s, body_penetration_mm,
/// plan_microseconds_per_agent_step, runs[]}}`: means over seeds, with standard deviations under the same names and
/// `_sd`; `stalled` counts runs in which an agent stalls. `runs[]` are the seeds: `seed`, what `fbcrowd measure --json`
/// prints, and `plan_microseconds_per_agent_step`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench table1 --plots out/plots\n  fbcrowd bench table1 --scenes my/scenes --seeds 1,2 --json\n  fbcrowd bench table1 --discs"
)]
pub(super) struct Args {
    /// A folder of scenes `NAME_s<seed>.txt`, lines `x y goal_x goal_y`; the bundled ones by default.
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    /// Only these seeds.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    seeds: Vec<u64>,
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Compare the rivals without bodies with their published implementations instead.
    #[arg(long, conflicts_with_all = ["scenes", "plots", "hybrid"])]
    discs: bool,
    /// Write each run's root positions to `SCENE_s<seed>_PLANNER.txt`: a line a step, x y of each agent, metres.
    #[arg(long, value_name = "DIR")]
    trajectories: Option<PathBuf>,
    /// Write the table as a picture, and the paths of each scene's first seed.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Let bodies change between blending and semi-procedural locomotion instead of blending alone.
    #[arg(long)]
    hybrid: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
pub(super) struct Details {
    pub(super) scenes: Vec<SceneFigures>,
}

/// One scene, by planner.
#[derive(Serialize)]
pub(super) struct SceneFigures {
    pub(super) scene: String,
    pub(super) agents: usize,
    pub(super) planners: Vec<PlannerFigures>,
}

/// Means and standard deviations over the seeds of one scene.
#[derive(Serialize)]
pub(super) struct PlannerFigures {
    pub(super) planner: &'static str,
    pub(super) collision_rate: f64,
    pub(super) collision_rate_sd: f64,
    pub(super) mean_acceleration_mps2: f64,
    pub(super) mean_acceleration_mps2_sd: f64,
    pub(super) mean_acceleration_before_arrival_mps2: f64,
    pub(super) mean_acceleration_before_arrival_mps2_sd: f64,
    pub(super) arrived_share: f64,
    /// Runs.
    pub(super) stalled: usize,
    /// Null where nobody arrives in any run.
    pub(super) mean_time_to_goal_s: Option<f64>,
    pub(super) mean_time_to_goal_s_sd: Option<f64>,
    pub(super) body_penetration_mm: f64,
    pub(super) body_penetration_mm_sd: f64,
    pub(super) plan_microseconds_per_agent_step: f64,
    pub(super) runs: Vec<RunFigures>,
}

/// One run.
#[derive(Serialize)]
pub(super) struct RunFigures {
    pub(super) seed: u64,
    #[serde(flatten)]
    pub(super) measures: Measures,
    pub(super) plan_microseconds_per_agent_step: f64,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let protocol = Protocol {
        // As in the paper's comparison; none of the planners gains by the hybrid.
        modes: if args.hybrid { Modes::Hybrid } else { Modes::Blending },
        keeps_tracks: args.plots.is_some(),
        trajectories: args.trajectories.clone(),
        ..Protocol::default()
    };
    if args.discs {
        return table1_discs::run(&db, &args.seeds, protocol, args.json);
    }
    let scenes = match &args.scenes {
        Some(folder) => scenes::of_folder(folder, &args.seeds)?,
        None => scenes::bundled(&args.seeds)?,
    };
    let runs = run_all(&db, &scenes, &CONTESTANTS, &protocol)?;
    let details = Details { scenes: figures(&scenes, &CONTESTANTS, &runs) };
    if let Some(folder) = &args.plots {
        table1_plots::write(folder, &details, &scenes, &runs)?;
    }
    let bars = details.scenes.iter().flat_map(bars).collect();
    let text = table1_text::text(&details);
    conclude(&Found { goals: goals(&details), details, bars }, &text, args.json)
}

/// Averages runs that came by scene and contestant over the seeds of each scene's name, in order of first appearance.
pub(super) fn figures(scenes: &[Scene], contestants: &[Contestant], runs: &[Run]) -> Vec<SceneFigures> {
    let mut names: Vec<&str> = Vec::new();
    for scene in scenes {
        if !names.contains(&scene.name.as_str()) {
            names.push(&scene.name);
        }
    }
    let by_scene: Vec<(&Scene, &[Run])> = scenes.iter().zip(runs.chunks(contestants.len())).collect();
    let of_name = |name: &str| {
        let of_scene: Vec<&(&Scene, &[Run])> = by_scene.iter().filter(|(scene, _)| scene.name == name).collect();
        let planner = |(index, contestant): (usize, &Contestant)| {
            planner_figures(contestant.name, of_scene.iter().map(|(_, runs)| &runs[index]).collect())
        };
        SceneFigures {
            scene: name.to_owned(),
            agents: of_scene.first().map_or(0, |(scene, _)| scene.agents.len()),
            planners: contestants.iter().enumerate().map(planner).collect(),
        }
    };
    names.into_iter().map(of_name).collect()
}

fn planner_figures(planner: &'static str, runs: Vec<&Run>) -> PlannerFigures {
    let of = |value: fn(&Run) -> f64| {
        spread(runs.iter().map(|run| value(run))).unwrap_or(Spread { mean: 0.0, deviation: 0.0 })
    };
    let collisions = of(|run| run.measures.collision_rate);
    let acceleration = of(|run| run.measures.mean_acceleration_mps2);
    let before_arrival = of(|run| run.measures.mean_acceleration_before_arrival_mps2);
    let bodies = of(|run| run.measures.body_penetration_mm);
    let time_to_goal = spread(runs.iter().filter_map(|run| run.measures.mean_time_to_goal_s));
    PlannerFigures {
        planner,
        collision_rate: collisions.mean,
        collision_rate_sd: collisions.deviation,
        mean_acceleration_mps2: acceleration.mean,
        mean_acceleration_mps2_sd: acceleration.deviation,
        mean_acceleration_before_arrival_mps2: before_arrival.mean,
        mean_acceleration_before_arrival_mps2_sd: before_arrival.deviation,
        arrived_share: of(|run| run.measures.arrived as f64 / run.measures.agents as f64).mean,
        stalled: runs.iter().filter(|run| run.measures.stalled > 0).count(),
        mean_time_to_goal_s: time_to_goal.map(|time| time.mean),
        mean_time_to_goal_s_sd: time_to_goal.map(|time| time.deviation),
        body_penetration_mm: bodies.mean,
        body_penetration_mm_sd: bodies.deviation,
        plan_microseconds_per_agent_step: of(|run| run.plan_microseconds_per_agent_step).mean,
        runs: runs.into_iter().map(RunFigures::new).collect(),
    }
}

impl RunFigures {
    fn new(run: &Run) -> Self {
        Self {
            seed: run.seed,
            measures: run.measures.clone(),
            plan_microseconds_per_agent_step: run.plan_microseconds_per_agent_step,
        }
    }
}

/// What MCN must keep in one scene. The rivals run at dt; that with sub-steps stands beside them.
fn bars(scene: &SceneFigures) -> Vec<Bar> {
    let [mcn, orca, social_force, _] = &scene.planners[..] else { return Vec::new() };
    let name = |what: &str| format!("{}: {what}", scene.scene);
    let lower = |value: fn(&PlannerFigures) -> f64| value(orca).min(value(social_force));
    let ratio = mcn.mean_time_to_goal_s.zip(orca.mean_time_to_goal_s).map(|(mcn_s, orca_s)| mcn_s / orca_s);
    vec![
        Bar::below(
            name("MCN's C, below both rivals' or none"),
            lower(|planner| planner.collision_rate),
            mcn.collision_rate,
        ),
        Bar::below(
            name("MCN's acceleration before arrival, below both rivals', m/s²"),
            lower(|planner| planner.mean_acceleration_before_arrival_mps2),
            mcn.mean_acceleration_before_arrival_mps2,
        ),
        Bar::at_least(name("share of MCN's agents that arrive"), 1.0, mcn.arrived_share),
        Bar::at_most(name("MCN's runs in which an agent stalls"), 0.0, mcn.stalled as f64),
        Bar::at_most(name("MCN's mean time to goal over ORCA's"), TIME_TO_GOAL_RATIO, ratio),
    ]
}

fn goals(details: &Details) -> Vec<Goal> {
    let planned = details.scenes.iter().filter_map(|scene| scene.planners.first());
    let slowest = planned.map(|mcn| mcn.plan_microseconds_per_agent_step).reduce(f64::max);
    vec![Goal {
        name: "MCN's planning in the slowest scene, µs an agent and step",
        measured: slowest,
        goal: PLAN_GOAL_US,
    }]
}

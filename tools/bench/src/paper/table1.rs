//! `fbcrowd bench table1`: MCN against its two baselines through the same bodies, the paper's Table 1 (§7, App. 11).
//!
//! Protocol: 60 s in steps of 0.1 s (or `--dt`) for all, one set of parameters for all scenes, the same blending
//! synthesis, measures of the synthesised roots, means over seeds. The criteria are MCN's: C below both baselines', its
//! acceleration before arrival too, all agents arrive, none stalls, and in time.

use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::synthesis::Modes;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PlotsArg, SeedsArg, StepArg};
use crate::kit::database::database;
use crate::kit::planner_comparison::{ComparedPlanner, MCN, ORCA, Protocol, SOCIAL_FORCE, SOCIAL_FORCE_20, compare};
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::scenes;
pub use crate::paper::table1_figures::Details;
use crate::paper::table1_figures::{PlannerFigures, SceneFigures, figures};
use crate::paper::{table1_discs, table1_plots, table1_text};

/// Planners of the table, in its order.
const PLANNERS: [ComparedPlanner; 4] = [MCN, ORCA, SOCIAL_FORCE, SOCIAL_FORCE_20];
/// Greatest ratio of MCN's mean time to goal to ORCA's.
const TIME_TO_GOAL_RATIO: f64 = 1.1;
/// Goal for planning on a quiet core, µs per agent and step: about what RVO2 takes, neighbour query included.
const PLAN_GOAL_US: f64 = 1.5;

/// Run MCN, ORCA and social forces through the same bodies, as the paper's Table 1 does.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench table1 --plots out/plots\n  fbcrowd bench table1 --scenes my/scenes --seeds 1,2 --json\n  fbcrowd bench table1 --dt 1/60\n  fbcrowd bench table1 --discs"
)]
pub struct Args {
    /// A folder of scenes `NAME_s<seed>.txt`, lines `x y goal_x goal_y`; the bundled ones by default.
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    #[command(flatten)]
    seeds: SeedsArg,
    #[command(flatten)]
    step: StepArg,
    #[command(flatten)]
    database: DatabaseArg,
    /// Compare the baselines without bodies with their published implementations instead.
    #[arg(long, conflicts_with_all = ["scenes", "dt_s", "plots", "hybrid"])]
    discs: bool,
    /// Write each run's root positions to `SCENE_s<seed>_PLANNER.txt`: a line a step, x y of each agent, metres.
    #[arg(long, value_name = "DIR")]
    trajectories: Option<PathBuf>,
    #[command(flatten)]
    plots: PlotsArg,
    /// Let bodies change between blending and semi-procedural locomotion instead of blending alone.
    #[arg(long)]
    hybrid: bool,
}

/// Runs the bench.
///
/// # Errors
/// If scenes or the database cannot be read, or an output cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    args.database.check_folder(args.plots.plots.as_ref())?;
    args.database.check_folder(args.trajectories.as_ref())?;
    let db = Arc::new(database(&args.database)?);
    let protocol = Protocol {
        dt_s: args.step.dt_s,
        // As in the paper's comparison; no planner gains by the hybrid.
        modes: if args.hybrid { Modes::Hybrid } else { Modes::Blending },
        keeps_tracks: args.plots.plots.is_some(),
        trajectories: args.trajectories.clone(),
        ..Protocol::default()
    };
    let seeds = &args.seeds.seeds;
    if args.discs {
        return table1_discs::run(&db, seeds, protocol, observer);
    }
    let scenes = match &args.scenes {
        Some(folder) => scenes::of_folder(folder, seeds)?,
        None => scenes::bundled(seeds)?,
    };
    let runs = compare(&db, &scenes, &PLANNERS, &protocol, observer)?;
    let details = Details { scenes: figures(&scenes, &PLANNERS, &runs) };
    if let Some(folder) = &args.plots.plots {
        table1_plots::draw(folder, &details.scenes, &PLANNERS, &scenes, &runs)?;
    }
    let criteria = details.scenes.iter().flat_map(criteria).collect();
    Ok(BenchReport { text: table1_text::text(&details.scenes), goals: goals(&details), details, criteria })
}

/// Criteria of MCN in one scene. Its baselines run with the same time step; the one with sub-steps has no criterion.
fn criteria(scene: &SceneFigures) -> Vec<Criterion> {
    let [mcn, orca, social_force, _] = &scene.planners[..] else { return Vec::new() };
    let name = |what: &str| format!("{}: {what}", scene.scene);
    let lower = |value: fn(&PlannerFigures) -> f64| value(orca).min(value(social_force));
    let ratio = mcn.mean_time_to_goal_s.zip(orca.mean_time_to_goal_s).map(|(mcn_s, orca_s)| mcn_s / orca_s);
    vec![
        Criterion::below(
            name("MCN's C, below both baselines' or none"),
            lower(|planner| planner.collision_rate),
            mcn.collision_rate,
        ),
        Criterion::below(
            name("MCN's acceleration before arrival, below both baselines', m/s²"),
            lower(|planner| planner.mean_acceleration_before_arrival_mps2),
            mcn.mean_acceleration_before_arrival_mps2,
        ),
        Criterion::at_least(name("share of MCN's agents that arrive"), 1.0, mcn.arrived_share),
        Criterion::at_most(name("MCN's runs in which an agent stalls"), 0.0, mcn.stalled as f64),
        Criterion::at_most(name("MCN's mean time to goal over ORCA's"), TIME_TO_GOAL_RATIO, ratio),
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

//! `fbcrowd bench scenes`: the paper's scenes (§7), each also ten times larger: a street crossing, a tradeshow, a
//! shopping mall, and the obstacle course.
//!
//! The paper states the number of agents and frames per second, and shows pictures; it gives no geometry and no figure
//! of quality. So the criteria are ours: bodies stay out of walls, discs do not collide, no agent is blocked for long, and the
//! scene goes on as its behaviour describes it. [`scene_run`](crate::paper::scene_run) simulates one scene.

use std::sync::Arc;

use fbcrowd_jobs::Observer;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PlotsArg};
use crate::kit::database::database;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::scenario_run::{ScenarioFile, scenario, scenario_file};
use crate::kit::threads::run_each_on_one_thread;
use crate::paper::scene_run::{SceneFigures, draw, simulate};

/// A scene, and what goes on in it.
struct PaperScene {
    file: ScenarioFile,
    activity: Activity,
}

/// What agents of a scene do, and the least of it that a criterion wants.
#[derive(Clone, Copy)]
enum Activity {
    /// The share of the agents of the start that are gone at the end: the signal is green for them at least once.
    Leave(f64),
    /// Entries into a state per minute and present agent.
    Visit(&'static str, f64),
    /// The share of agents that arrive at their goals.
    Arrive(f64),
}

/// Visits of a booth per minute at the least. A visit takes 3 to 8 s, and 15 to 30 m of walking at 1.1 m/s: 1.8 to 3.2
/// per minute; crowds and full booths may cost a third of the least.
const BOOTHS_PER_MIN: f64 = 1.2;
/// Shelves and windows per minute at the least. A visit takes 5 to 15 s, and 10 to 20 m of walking at .9 m/s: 1.6 to 2.9
/// per minute; full shops may cost half of the least.
const SHOPS_PER_MIN: f64 = 0.8;

const SCENES: [PaperScene; 7] = [
    PaperScene { file: scenario_file!("shibuya.toml"), activity: Activity::Leave(1.0) },
    PaperScene { file: scenario_file!("shibuya_large.toml"), activity: Activity::Leave(1.0) },
    PaperScene { file: scenario_file!("tradeshow.toml"), activity: Activity::Visit("look", BOOTHS_PER_MIN) },
    PaperScene { file: scenario_file!("tradeshow_large.toml"), activity: Activity::Visit("look", BOOTHS_PER_MIN) },
    PaperScene { file: scenario_file!("mall.toml"), activity: Activity::Visit("look", SHOPS_PER_MIN) },
    PaperScene { file: scenario_file!("mall_large.toml"), activity: Activity::Visit("look", SHOPS_PER_MIN) },
    PaperScene { file: scenario_file!("obstacle_course.toml"), activity: Activity::Arrive(1.0) },
];

/// Greatest share of agent-steps with a capsule more than 1 cm inside a wall: a shoulder that grazes a corner in every hundredth step.
const IN_WALLS: f64 = 0.01;
/// Greatest collision rate of discs; up to 2e-5 was measured.
const COLLISIONS: f64 = 1e-4;
/// Greatest overlap of bodies per agent and step, mm; .4 to 1.9 was measured.
const OVERLAP_MM: f64 = 3.0;
/// Greatest number of times that an agent is blocked for 5 s, per agent and minute: once in ten minutes.
const BLOCKED_PER_MIN: f64 = 0.1;
/// Goal: time of an agent's step, µs.
const AGENT_STEP_US: f64 = 5.0;

/// Simulate the paper's scenes: a crossing, a tradeshow, a mall and an obstacle course, each also ten times larger.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench scenes\n  fbcrowd bench scenes --largest 50 --seeds 2,3 --plots out/plots"
)]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    #[command(flatten)]
    plots: PlotsArg,
    /// Seeds to run; default: that of the scenario files.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    seeds: Vec<u64>,
    /// Leave out scenes with more agents at the start than this.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    largest: usize,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Runs: every scene with every seed.
    pub runs: Vec<SceneFigures>,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or a picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    args.database.check_folder(args.plots.plots.as_ref())?;
    let db = Arc::new(database(&args.database)?);
    let mut scenes = Vec::new();
    for scene in &SCENES {
        let scenario = scenario(scene.file)?;
        if scenario.agents.len() > args.largest {
            continue;
        }
        let seeds = if args.seeds.is_empty() { vec![scenario.seed] } else { args.seeds.clone() };
        scenes.extend(seeds.into_iter().map(|seed| (scene, fbcrowd_sim::Scenario { seed, ..scenario.clone() })));
    }
    let results = run_each_on_one_thread(scenes.len(), observer, |index| simulate(&db, &scenes[index].1))?;
    let (mut runs, mut criteria) = (Vec::new(), Vec::new());
    for ((scene, scenario), (figures, moments)) in scenes.iter().zip(results) {
        if let Some(folder) = &args.plots.plots {
            draw(folder, &db, scenario, &moments)?;
        }
        criteria.extend(scene.criteria(&figures));
        runs.push(figures);
    }
    let slowest_us = runs.iter().map(|run| run.agent_step_us).reduce(f64::max);
    let goals = vec![Goal { name: "slowest scene, µs per agent-step", measured: slowest_us, goal: AGENT_STEP_US }];
    Ok(BenchReport { text: text(&runs), details: Details { runs }, goals, criteria })
}

impl PaperScene {
    fn criteria(&self, run: &SceneFigures) -> Vec<Criterion> {
        let named = |what: &str| format!("{}, seed {}: {what}", run.scene, run.seed);
        let activity = match self.activity {
            Activity::Leave(least) => {
                Criterion::at_least(named("share of the first agents that left"), least, run.left_of_first)
            }
            Activity::Visit(state, least) => {
                let visits = run.states.iter().find(|visited| visited.state == state);
                let per_min = visits.map(|visits| visits.per_agent_min);
                Criterion::at_least(named(&format!("visits of `{state}` per agent and minute")), least, per_min)
            }
            Activity::Arrive(least) => {
                Criterion::at_least(named("share that arrived"), least, run.arrived as f64 / run.agents as f64)
            }
        };
        vec![
            Criterion::at_most(named("share of agent-steps > 1 cm in a wall"), IN_WALLS, run.wall_body_deep_share),
            Criterion::at_most(named("collisions of discs C"), COLLISIONS, run.collision_rate),
            Criterion::at_most(named("overlap of bodies, mm"), OVERLAP_MM, run.body_penetration_mm),
            Criterion::at_most(named("times blocked per agent and minute"), BLOCKED_PER_MIN, run.blocked_per_agent_min),
            activity,
        ]
    }
}

fn text(runs: &[SceneFigures]) -> String {
    let mut text = format!(
        "{:<17}{:>5}{:>8}{:>8}{:>8}{:>7}{:>10}{:>8}{:>10}{:>10}{:>8}{:>10}\n",
        "scene",
        "seed",
        "agents",
        "at once",
        "arrived",
        "gone",
        "C",
        "A, m/s²",
        "wall, %",
        "body, mm",
        "blocked",
        "µs a step"
    );
    for run in runs {
        text += &format!(
            "{:<17}{:>5}{:>8}{:>8}{:>8}{:>7}{:>10.6}{:>8.3}{:>10.2}{:>10.3}{:>8}{:>10.2}\n",
            run.scene,
            run.seed,
            run.agents,
            run.most_at_once,
            run.arrived,
            run.removed,
            run.collision_rate,
            run.mean_acceleration_mps2,
            100.0 * run.wall_body_deep_share,
            run.body_penetration_mm,
            run.blocked,
            run.agent_step_us
        );
    }
    text.push('\n');
    for run in runs.iter().filter(|run| !run.states.is_empty()) {
        let states = run.states.iter().map(|state| format!("{} {} ({})", state.state, state.entered, state.blocked));
        text += &format!(
            "{}, seed {}: states entered (blocked) {}\n",
            run.scene,
            run.seed,
            states.collect::<Vec<_>>().join(", ")
        );
    }
    text
}

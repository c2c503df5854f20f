//! `fbcrowd bench figure7`: the antipodal circle with each of three planners, side by side (the paper's Fig. 7).

use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::synthesis::Modes;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PictureArg};
use crate::kit::database::database;
use crate::kit::planner_comparison::{ComparedPlanner, MCN, ORCA, Protocol, SOCIAL_FORCE, compare};
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::scenario_run::create_parent;
use crate::kit::scenes::{self, Scene};
use crate::paper::table1_figures::{SceneFigures, figures};
use crate::paper::table1_plots::draw_paths;

/// Planners, from left to right.
const PLANNERS: [ComparedPlanner; 3] = [MCN, ORCA, SOCIAL_FORCE];
/// Name of the scene.
const SCENE: &str = "circle_17";
/// Seed of the scene.
const SEED: u64 = 1;

/// Draw the paths of 17 agents that cross a circle, with each of three planners, and their measures.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench figure7 -o figure7.png")]
pub struct Args {
    #[command(flatten)]
    picture: PictureArg,
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Path of the picture.
    pub picture: PathBuf,
    /// The scene, as `fbcrowd bench table1` has it.
    pub scenes: Vec<SceneFigures>,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or the picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let picture = args.picture.path("figure7");
    args.database.check_file(&picture)?;
    create_parent(&picture)?;
    let db = Arc::new(database(&args.database)?);
    let scenes: Vec<Scene> = scenes::bundled(&[SEED])?.into_iter().filter(|scene| scene.name == SCENE).collect();
    let protocol = Protocol { modes: Modes::Blending, keeps_tracks: true, ..Protocol::default() };
    let runs = compare(&db, &scenes, &PLANNERS, &protocol, observer)?;
    for scene in &scenes {
        draw_paths(&picture, scene, &PLANNERS, &runs)?;
    }
    let text = format!("written: {}\n", picture.display());
    let details = Details { picture, scenes: figures(&scenes, &PLANNERS, &runs) };
    let mcn = details.scenes.iter().flat_map(|scene| &scene.planners).find(|planner| planner.planner == MCN.name);
    let arrived_share = mcn.map(|planner| planner.arrived_share);
    let criteria = vec![Criterion::at_least("share of MCN's agents that arrive", 1.0, arrived_share)];
    Ok(BenchReport { details, goals: Vec::new(), criteria, text })
}

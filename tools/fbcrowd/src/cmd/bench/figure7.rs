//! `fbcrowd bench figure7`: the antipodal circle as the three planners lead it, side by side (the paper's Fig. 7).

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_sim::synthesis::Modes;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::contest::{Contestant, MCN, ORCA, Protocol, SOCIAL_FORCE, run_all};
use crate::cmd::bench::scenes::{self, Scene};
use crate::cmd::bench::table1::{SceneFigures, figures};
use crate::cmd::bench::table1_plots::write_paths;
use crate::failure::{Answer, Failure};

const CONTESTANTS: [Contestant; 3] = [MCN, ORCA, SOCIAL_FORCE];
const SCENE: &str = "circle_17";
const SEED: u64 = 1;

/// Draw the paths of 17 people who cross a circle, as each planner leads them; figures stand beneath.
///
/// In JSON `picture`, its file, and `scenes[]` as `fbcrowd bench table1` has it.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench figure7 -o figure7.png")]
pub(super) struct Args {
    /// The picture.
    #[arg(short, long, value_name = "FILE.png", default_value = "out/figure7.png")]
    output: PathBuf,
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    picture: PathBuf,
    scenes: Vec<SceneFigures>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    if let Some(folder) = args.output.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let db = Arc::new(database(args.database.as_deref())?);
    let scenes: Vec<Scene> = scenes::bundled(&[SEED])?.into_iter().filter(|scene| scene.name == SCENE).collect();
    let protocol = Protocol { modes: Modes::Blending, keeps_tracks: true, ..Protocol::default() };
    let runs = run_all(&db, &scenes, &CONTESTANTS, &protocol)?;
    for scene in &scenes {
        write_paths(&args.output, scene, &CONTESTANTS, &runs)?;
    }
    let details = Details { picture: args.output.clone(), scenes: figures(&scenes, &CONTESTANTS, &runs) };
    let arrived = details.scenes.iter().flat_map(|scene| &scene.planners).find(|planner| planner.planner == MCN.name);
    let bars =
        vec![Bar::at_least("share of MCN's agents that arrive", 1.0, arrived.map(|planner| planner.arrived_share))];
    let text = format!("written: {}\n", args.output.display());
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

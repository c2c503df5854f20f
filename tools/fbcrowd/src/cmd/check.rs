//! `fbcrowd check`: a scenario before it is simulated, as figures and as one picture.

use std::collections::BTreeSet;
use std::path::PathBuf;

use fbcrowd_jobs::camera_file;
use fbcrowd_jobs::character::ScenarioCharacters;
use fbcrowd_jobs::clip_paths;
use fbcrowd_jobs::output_path::{check_file, check_is_no_input};
use fbcrowd_jobs::scene_check::check_scene;
use fbcrowd_sim::scenario::{self, MotionSource};
use motiondb::files::database_file;

use crate::cmd::outside_arg::OutsideArg;
use crate::cmd::png_path::check_is_png;
use crate::report::crowd::scene_text;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Check a scenario without simulating it: agents, routes, closed passages, memory, size of the recording.
///
/// The picture shows walls, the mesh that routes use, the route of each agent, sources, goals and closed passages.
///
/// Files that it names are read, too: database, manifest of clips, characters and cameras. It need not name a motion,
/// nor have agents: a plan is drawn with its walls and its closed passages.
///
/// Exit code 0: the scenario can be simulated, or would be if it had agents; 2: it has a mistake, which is shown at its
/// line, or one of its files has.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd check assets/scenarios/tradeshow.toml\n  fbcrowd check my/scene.toml --plot scene.png --json"
)]
pub(crate) struct Args {
    /// The scenario.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Draw the scenario.
    #[arg(short, long, value_name = "OUT.png")]
    plot: Option<PathBuf>,
    /// Print JSON; docs/json.md describes it.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outside: OutsideArg,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (mut scenario, motion) = scenario::read_plan(&args.scenario)?;
    if scenario::names_motion(&args.scenario)? {
        scenario::check_styles(&args.scenario, &styles_of(motion?)?)?;
    }
    let camera_files = camera_file::files(&scenario, &args.scenario);
    camera_file::resolve(&mut scenario, &args.scenario, args.outside.into())?;
    let characters = ScenarioCharacters::load(&args.scenario, &scenario, args.outside.into(), &|_| {})?;
    if let Some(plot) = &args.plot {
        let agent_files = scenario::agent_files(&args.scenario)?;
        let inputs = [vec![args.scenario.clone()], agent_files, camera_files, characters.files].concat();
        check_is_no_input(plot, &inputs)?;
        check_is_png(plot)?;
        check_file(plot)?;
    }
    let check = check_scene(scenario)?;
    if let Some(plot) = &args.plot {
        check.draw(plot)?;
        output::say(&format!("drew {}", plot.display()));
    }
    if args.json {
        output::print_json(&check.figures)?;
    } else {
        output::print(&scene_text::text(&check.figures))?;
    }
    Ok(Answer::Yes)
}

/// The styles of a scenario's motion, which must be readable: of its database, or of the list of its clips.
fn styles_of(motion: MotionSource) -> Result<Vec<String>, Failure> {
    Ok(match motion {
        MotionSource::Database(path) => database_file::load(&path)?.0.style_names(),
        MotionSource::Clips(clips) => {
            let names: BTreeSet<String> = clip_paths::manifest(&[clips])?.styles().into_iter().collect();
            names.into_iter().collect()
        }
    })
}

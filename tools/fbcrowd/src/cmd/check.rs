//! `fbcrowd check`: a scenario before it is simulated, as figures and as one picture.

use std::path::PathBuf;

use fbcrowd_jobs::output_path::{check_file, check_is_no_input};
use fbcrowd_jobs::scene_check::check_scene;
use fbcrowd_sim::scenario;

use crate::report::crowd::scene_text;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Check a scenario without simulating it: agents, routes, closed passages, memory, size of the recording.
///
/// The picture shows walls, the mesh that routes use, the route of each agent, sources, goals and closed passages.
///
/// Exit code 0: the scenario can be simulated; 2: it has a mistake, which is shown at its line.
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
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (scenario, _) = scenario::read(&args.scenario)?;
    if let Some(plot) = &args.plot {
        let inputs = [vec![args.scenario.clone()], scenario::agent_files(&args.scenario)?].concat();
        check_is_no_input(plot, &inputs)?;
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

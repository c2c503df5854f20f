//! `fbcrowd run`: the main job in one line: compile, simulate, measure, render.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::compiling::{self, Overrides};
use fbcrowd_jobs::rendering::{self, RenderedSequence};
use fbcrowd_jobs::simulation::{self, SimulationInput};
use fbcrowd_jobs::wording::counted;
use fbcrowd_jobs::{JobEvent, Observer};
use fbcrowd_render::top_view::{PictureFormat, SequenceOptions};
use fbcrowd_sim::measures;
use fbcrowd_sim::scenario::{self, MotionSource};
use motiondb::files::database_file;
use motiondb_compiler::Compiled;

use crate::cmd::rejected;
use crate::report::{measures_text, timings_text};
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Compile the clips of a scenario, then simulate and render the scenario.
///
/// Writes `motion.fbdb`, `NAME.fbrec`, `trajectories.png` and `frames/NAME.####.png`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd run assets/scenarios/antipodal.toml")]
pub(crate) struct Args {
    /// The scenario.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// The folder to write to; `out/NAME` by default.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let progress = ProgressDisplay::default();
    let observer = |event: JobEvent<'_>| progress.observe(event);
    let (scenario, motion) = scenario::read(&args.scenario)?;
    let name = scenario.name.clone();
    let folder = args.output.clone().unwrap_or_else(|| Path::new("out").join(&name));
    let recording_path = folder.join(format!("{name}.fbrec"));
    let (database, answer) = database(motion?, &folder, &observer)?;
    let (db, database_checksum) = database_file::load(&database)?;

    let input = SimulationInput { db, database_checksum, scenario };
    let timings = simulation::simulate(input, &recording_path, &observer)?;
    let recording = rendering::open(&recording_path)?;
    let measures = measures::measure(&recording)?;
    rendering::plot_trajectories(&recording, &folder.join("trajectories.png"))?;
    let options = SequenceOptions {
        folder: folder.join("frames"),
        name,
        format: PictureFormat::Png,
        frames: None,
        constraints_of: Vec::new(),
    };
    rendering::remove_frames(&options)?;
    let rendered = rendering::render(&recording, &options, &observer)?;

    let figures = measures_text::text(&measures) + &timings_text::text(&timings);
    output::print(&(figures + &outputs_text(&rendered, &folder)))?;
    Ok(answer)
}

/// The scenario's database. Where the scenario names clips, they are compiled into the output folder.
fn database(motion: MotionSource, folder: &Path, observer: &Observer) -> Result<(PathBuf, Answer), Failure> {
    let create_folder = || fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, error));
    match motion {
        MotionSource::Database(path) => {
            // Read before anything is written.
            database_file::load(&path)?;
            create_folder()?;
            Ok((path, Answer::Yes))
        }
        MotionSource::Clips(clips) => {
            let path = folder.join("motion.fbdb");
            let Compiled { db, rejected } = compiling::compile(&[clips], &path, &Overrides::default(), observer)?;
            rejected::print(&rejected);
            create_folder()?;
            compiling::write_database(&path, &db, observer)?;
            Ok((path, rejected::answer(&rejected)))
        }
    }
}

fn outputs_text(rendered: &RenderedSequence, folder: &Path) -> String {
    let rendering = format!("{}, {:.1} ms a frame", counted(rendered.frames, "frame", "frames"), rendered.ms_per_frame);
    format!("{:<25}{rendering}\n{:<25}{}", "rendering", "written to", folder.display())
}

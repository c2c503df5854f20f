//! `fbcrowd run`: the main job in one line: compile, simulate, measure, render.

use std::path::{Path, PathBuf};
use std::{fs, io};

use fbcrowd_render::top_view::{PictureFormat, SequenceOptions};
use fbcrowd_sim::measures;
use fbcrowd_sim::scenario::{self, MotionSource};
use motiondb::files::database_file;
use motiondb_compiler::compile::Compiled;

use crate::cmd::measure;
use crate::compile_text::counted;
use crate::compiling::{self, Overrides};
use crate::failure::{Answer, Failure};
use crate::output;
use crate::rendering::{self, Rendered};
use crate::simulation::{self, Timings};
use crate::stages::Stopwatch;

/// Compile a scenario's clips, simulate it, and render it.
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
    let (scenario, motion) = scenario::read(&args.scenario)?;
    let name = scenario.name.clone();
    let folder = args.output.clone().unwrap_or_else(|| Path::new("out").join(&name));
    let recording_path = folder.join(format!("{name}.fbrec"));
    let (database, answer) = database(motion?, &folder)?;
    let (db, checksum) = database_file::load(&database)?;

    let timings = simulation::simulate(db, checksum, scenario, &recording_path)?;
    let recording = rendering::open(&recording_path)?;
    let measures = measures::measure(&recording).map_err(|error| Failure::bad(error.to_string()))?;
    rendering::plot_trajectories(&recording, &folder.join("trajectories.png"))?;
    let options = SequenceOptions {
        folder: folder.join("frames"),
        name,
        format: PictureFormat::Png,
        frames: None,
        constraints_of: Vec::new(),
    };
    remove_frames(&options).map_err(|error| Failure::unwritable(&options.folder, &error))?;
    let rendered = rendering::render(&recording, &options)?;

    output::print(&summary(&measure::text(&measures), &timings, &rendered, &folder))?;
    Ok(answer)
}

/// The scenario's database, compiled into the output folder where it names clips.
fn database(motion: MotionSource, folder: &Path) -> Result<(PathBuf, Answer), Failure> {
    let clips = match motion {
        MotionSource::Database(path) => {
            database_file::load(&path)?; // before anything is written
            fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
            return Ok((path, Answer::Yes));
        }
        MotionSource::Clips(path) => path,
    };
    let path = folder.join("motion.fbdb");
    let Compiled { db, rejected } = compiling::compile(&[clips], &path, &Overrides::default(), &Stopwatch::default())?;
    compiling::say_refused(&rejected);
    fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    database_file::write(&path, &db)?;
    Ok((path, compiling::answer(&rejected)))
}

/// Frames of an earlier and longer run would follow on this one's last.
fn remove_frames(options: &SequenceOptions) -> io::Result<()> {
    let Ok(entries) = fs::read_dir(&options.folder) else { return Ok(()) };
    let is_frame = |file: &str| {
        let number = file.strip_prefix(&format!("{}.", options.name)).and_then(|rest| rest.strip_suffix(".png"));
        number.is_some_and(|number| number.len() >= 4 && number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    for entry in entries {
        let entry = entry?;
        if entry.file_name().to_str().is_some_and(is_frame) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

fn summary(measures: &str, timings: &Timings, rendered: &Rendered, folder: &Path) -> String {
    let rendering = format!("{}, {:.1} ms a frame", counted(rendered.frames, "frame", "frames"), rendered.ms_per_frame);
    format!("{measures}{}{:<25}{rendering}\n{:<25}{}", timings.text(), "rendering", "written to", folder.display())
}

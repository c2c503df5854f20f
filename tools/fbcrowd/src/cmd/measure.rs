//! `fbcrowd measure`: the figures of a recording.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use fbcrowd_jobs::JobError;
use fbcrowd_jobs::output_path::{check_file, check_files, check_is_no_input, is_same_file};
use fbcrowd_render::plots::crowd::{place_plot_path, write_place_plots};
use fbcrowd_sim::measures;
use fbcrowd_sim::recording::{FrameTimes, Recording};
use fbcrowd_sim::scenario::{ShotSpec, check_shot};
use motiondb::files::atomic_file::AtomicFile;

use crate::report::crowd::{measures_text, people_text};
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Measure collisions, acceleration, arrivals, detours, bodies' overlap, foot slide and tracking of a recording.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd measure out/antipodal/antipodal.fbrec --json\n  fbcrowd measure crossing.fbrec --table crossing.csv\n  fbcrowd measure crossing.fbrec --people --incidents moments.csv"
)]
pub(crate) struct Args {
    /// The recording.
    #[arg(value_name = "FILE.fbrec")]
    recording: PathBuf,
    /// Print JSON; docs/json.md describes it.
    #[arg(long)]
    json: bool,
    /// Write the root positions, a line a step; docs/json.md describes the format.
    #[arg(long, value_name = "OUT.txt")]
    trajectories: Option<PathBuf>,
    /// Write a table, a row per step and agent, as CSV; docs/json.md describes the columns.
    #[arg(long, value_name = "OUT.csv")]
    table: Option<PathBuf>,
    /// Draw each `[[measure]]` table of the scenario: N–t of lines and of the egress, density in areas.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Measure only whether bodies move as people do, and differ as people do; docs/measures.md defines the measures.
    #[arg(long, conflicts_with_all = ["trajectories", "table", "plots", "fps"])]
    people: bool,
    /// With `--people`: write the moments that are counted (lurches, shanks too near, turns), with agent and frames, as
    /// CSV; docs/measures.md describes the columns.
    #[arg(long, value_name = "OUT.csv", requires = "people")]
    incidents: Option<PathBuf>,
    /// Measure only the slide of planted feet in frames at this rate, beside that of the recorded frames.
    #[arg(long, value_name = "RATE", conflicts_with_all = ["json", "trajectories", "table", "plots"])]
    fps: Option<f32>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let recording = Recording::open(&args.recording)?;
    if let Some(fps) = args.fps {
        return measure_shot(&recording, fps);
    }
    if args.people {
        return measure_people(args, &recording);
    }
    check_outputs(args, &recording)?;
    let measures = measures::measure(&recording)?;
    if let Some(path) = &args.trajectories {
        write(path, |out| measures::write_trajectories(&recording, out))?;
    }
    if let Some(path) = &args.table {
        write(path, |out| measures::write_table(&recording, out))?;
    }
    if let Some(folder) = &args.plots {
        write_place_plots(&measures.places, recording.header().scenario.duration_s, folder)?;
    }
    if args.json {
        output::print_json(&measures)?;
    } else {
        output::print(&measures_text::text(&measures))?;
    }
    Ok(Answer::Yes)
}

/// Prints the measures of people, and writes their incidents.
fn measure_people(args: &Args, recording: &Recording) -> Result<Answer, Failure> {
    check_outputs(args, recording)?;
    let people = measures::people::measure_people(recording)?;
    if let Some(path) = &args.incidents {
        write(path, |out| measures::people::write_incidents(&people.incidents, out))?;
    }
    if args.json {
        output::print_json(&people)?;
    } else {
        output::print(&people_text::text(&people))?;
    }
    Ok(Answer::Yes)
}

/// Prints the slide of planted feet in frames at a rate.
fn measure_shot(recording: &Recording, fps: f32) -> Result<Answer, Failure> {
    let scenario = &recording.header().scenario;
    let shot = ShotSpec { fps: Some(fps), ..scenario.shot.clone().unwrap_or_default() };
    check_shot(&shot, scenario.duration_s)
        .map_err(|fault| Failure::bad(format!("{}; {}", fault.message, fault.help)))?;
    let slide = measures::shot_slide(recording, &FrameTimes::of(&shot, scenario))?;
    let cm_s = |slide: Option<f64>| slide.map_or_else(|| "–".to_owned(), |slide| format!("{slide:.3} cm/s"));
    output::print(&format!(
        "{:<25}{} at {:.3} frames/s, {} recorded\n",
        "planted-foot slide",
        cm_s(slide.planted_slide_cm_s),
        slide.fps,
        cm_s(slide.recorded_slide_cm_s)
    ))?;
    Ok(Answer::Yes)
}

/// Checks that every output can be written, and replaces neither the recording nor another output.
fn check_outputs(args: &Args, recording: &Recording) -> Result<(), Failure> {
    for path in [&args.trajectories, &args.table, &args.incidents].into_iter().flatten() {
        check_is_no_input(path, [&args.recording])?;
        check_file(path)?;
    }
    if let Some(folder) = &args.plots {
        let measures = &recording.header().scenario.measures;
        if measures.is_empty() {
            let message = "the scenario of the recording measures no place, so there is nothing to plot";
            return Err(Failure::bad(format!("{message}; add [[measure]] to it, and simulate again")));
        }
        let names = measures.iter().map(|spec| spec.name.as_str());
        let plots: Vec<PathBuf> = names.map(|name| place_plot_path(name, folder)).collect();
        check_files(folder, &plots, std::slice::from_ref(&args.recording))?;
    }
    match (&args.trajectories, &args.table) {
        (Some(one), Some(other)) if is_same_file(one, other) => {
            Err(JobError::OneFileTwice { output: one.clone(), first: "trajectories", second: "table" }.into())
        }
        _ => Ok(()),
    }
}

fn write(path: &Path, content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), Failure> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        content(file.writer())?;
        file.commit()
    });
    written.map_err(|error| Failure::unwritable(path, error))
}

//! `fbcrowd measure`: what a recording is worth in figures.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use fbcrowd_sim::measures::{self, Measures};
use fbcrowd_sim::recording::Recording;
use motiondb::files::atomic_file::AtomicFile;

use crate::failure::{Answer, Failure};
use crate::output;

/// Measure collisions, acceleration, arrivals, detours, bodies' overlap, foot slide and tracking of a recording.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd measure out/antipodal/antipodal.fbrec --json\n  fbcrowd measure crossing.fbrec --table crossing.csv"
)]
pub(crate) struct Args {
    /// The recording.
    #[arg(value_name = "FILE.fbrec")]
    recording: PathBuf,
    /// Print JSON: `agents, steps, dt_s, collision_rate` (Eq. 17), `minimum_separation_m` (of centres, Eq. 16),
    /// `mean_acceleration_mps2` (Eq. 18), `mean_acceleration_before_arrival_mps2, arrived, stalled,
    /// mean_time_to_goal_s, path_over_straight_line, strafing_share, stepping_back_share, body_penetration_mm` (deepest
    /// overlap of capsules, summed over pairs, per agent and step), `body_penetration_touching_mm` (mean of those that
    /// touch), `body_penetration_max_mm, body_touching_share, wall_disc_share` (of agents and steps that a wall holds),
    /// `wall_body_share` (whose bodies reach into one), `wall_body_max_mm, planted_slide_cm_s, examples_slide_cm_s,
    /// planted_share` (all three before arrival), `root_tracking_error_m, root_tracking_worst_m` (of any step),
    /// `heading_error_deg` (facing against travel), `walking_heading_error_deg` (side-steps too); null where nobody
    /// arrived, touched or stood.
    #[arg(long)]
    json: bool,
    /// Write a line a step: x y of each agent's root, metres.
    #[arg(long, value_name = "OUT.txt")]
    trajectories: Option<PathBuf>,
    /// Write CSV, a row per step and agent: `step` (0 is the start), `time_s, agent, x_m, y_m, facing_deg` (from the x
    /// axis, counter-clockwise), `velocity_…` (of the root in the step before), `preferred_…` and `planned_x_mps,
    /// …_y_mps, mode` (blending, semi_procedural), `velocity_set` (turning; holding the facing), `strafing_s,
    /// stepping_back_s` (for how long), `phase` (of the gait), `left_contact, right_contact` (from 0.5 on the foot is
    /// planted), `time_to_landing_s` (of the other), `arrived` (1 once it was within 0.5 m of its last goal).
    #[arg(long, value_name = "OUT.csv")]
    table: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let bad = |error: fbcrowd_sim::recording::RecordingError| Failure::bad(error.to_string());
    let recording = Recording::open(&args.recording).map_err(bad)?;
    check_outputs(args)?;
    let measures = measures::measure(&recording).map_err(bad)?;
    if let Some(path) = &args.trajectories {
        write(path, |out| measures::write_trajectories(&recording, out))?;
    }
    if let Some(path) = &args.table {
        write(path, |out| measures::write_table(&recording, out))?;
    }
    if args.json {
        output::print_json(&measures)?;
    } else {
        output::print(&text(&measures))?;
    }
    Ok(Answer::Yes)
}

/// That no file is written over the recording, or over another.
fn check_outputs(args: &Args) -> Result<(), Failure> {
    for path in [&args.trajectories, &args.table].into_iter().flatten() {
        output::spare(path, [&args.recording])?;
    }
    match (&args.trajectories, &args.table) {
        (Some(one), Some(other)) if output::is_same_place(one, other) => {
            let file = one.display();
            Err(Failure::bad(format!("{file} cannot be both trajectories and table; give --table another name")))
        }
        _ => Ok(()),
    }
}

fn write(path: &Path, content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), Failure> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        content(file.writer())?;
        file.commit()
    });
    written.map_err(|error| Failure::unwritable(path, &error))
}

/// Figures for people, one a line.
pub(crate) fn text(measures: &Measures) -> String {
    [
        ("agents", format!("{}", measures.agents)),
        ("steps", format!("{} of {:.4} s", measures.steps, measures.dt_s)),
        ("collisions C", collisions(measures)),
        ("bodies", bodies(measures)),
        ("walls", walls(measures)),
        ("acceleration A", acceleration(measures)),
        ("arrived", format!("{} of {}, {} stalled", measures.arrived, measures.agents, measures.stalled)),
        ("mean time to goal", optional(measures.mean_time_to_goal_s, "s")),
        ("path", path(measures)),
        ("planted-foot slide", slide(measures)),
        ("root tracking error", tracking(measures)),
        ("facing off the travel", facing(measures)),
    ]
    .map(|(name, value)| format!("{name:<25}{value}\n"))
    .concat()
}

fn optional(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2} {unit}"))
}

fn collisions(measures: &Measures) -> String {
    let apart = optional(measures.minimum_separation_m, "m");
    format!("{:.5}, centres {apart} apart", measures.collision_rate)
}

fn bodies(measures: &Measures) -> String {
    format!(
        "{:.3} mm into each other, {} where they touch ({:.2} % of the time), {:.0} mm at most",
        measures.body_penetration_mm,
        optional(measures.body_penetration_touching_mm, "mm"),
        100.0 * measures.body_touching_share,
        measures.body_penetration_max_mm
    )
}

fn acceleration(measures: &Measures) -> String {
    format!(
        "{:.3} m/s², before arrival {:.3} m/s²",
        measures.mean_acceleration_mps2, measures.mean_acceleration_before_arrival_mps2
    )
}

fn path(measures: &Measures) -> String {
    format!(
        "{}, {:.1} % of the time strafing, {:.1} % stepping back",
        optional(measures.path_over_straight_line, "× the straight way"),
        100.0 * measures.strafing_share,
        100.0 * measures.stepping_back_share
    )
}

fn slide(measures: &Measures) -> String {
    format!(
        "{}, of the examples {}, planted {:.0} %",
        optional(measures.planted_slide_cm_s, "cm/s"),
        optional(measures.examples_slide_cm_s, "cm/s"),
        100.0 * measures.planted_share
    )
}

fn tracking(measures: &Measures) -> String {
    let [mean_mm, worst_mm] = [measures.root_tracking_error_m, measures.root_tracking_worst_m].map(|error| 1e3 * error);
    format!("{mean_mm:.2} mm a step, {worst_mm:.0} mm at most")
}

fn facing(measures: &Measures) -> String {
    let [meant_to, walking] = [measures.heading_error_deg, measures.walking_heading_error_deg];
    format!("{meant_to:.1}°, with side-steps and steps back {walking:.1}°")
}

fn walls(measures: &Measures) -> String {
    format!(
        "discs held {:.2} % of the time, bodies in them {:.2} %, {:.0} mm at most",
        100.0 * measures.wall_disc_share,
        100.0 * measures.wall_body_share,
        measures.wall_body_max_mm
    )
}

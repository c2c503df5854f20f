//! `fbcrowd inspect`: what a database holds, or what clips are, as a table, JSON and pictures.

use std::path::{Path, PathBuf};

use fbcrowd_render::plots::database::write_database_plots;
use motiondb::files::database_file::{self, FileError};
use motiondb_compiler::ClipSet;
use motiondb_compiler::survey::survey;

use crate::correspondence_between::Between;
use crate::failure::{Answer, Failure, NO_HUMAN};
use crate::leave_one_out::leave_one_out;
use crate::report::{self, DatabaseReport, SourcesReport};
use crate::{compiling, output};

/// Show what a database holds, or what was found in clips.
///
/// Exit code 0: shown; 1: an invariant of the database is broken, or some clip was refused; 2: nothing can be read.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd inspect motion.fbdb --plots out/plots\n  fbcrowd inspect motion.fbdb --leave-one-out\n  fbcrowd inspect motion.fbdb --correspondence walk_110 run_350\n  fbcrowd inspect my/clips --json"
)]
pub(crate) struct Args {
    /// A database, or clips: files or folders.
    #[arg(required = true, value_name = "FILE.fbdb|CLIPS")]
    input: Vec<PathBuf>,
    /// Print JSON: `sources[] {file, clip, speed_mps, turn_rate_rad_s, strafe_mps, up_axis, metres_per_unit,
    /// frame_rate_hz, warnings[], diagnostics[] {severity, code, arguments, text}}`, where `warnings[]` are the
    /// sentences of all `diagnostics[]`; of clips each with `gait {kind, reason, planted_share, right[] {strike_s,
    /// toe_off_s}, left[] {strike_s, toe_off_s}}`: kind is "steps", "stands" or "unsteady" (with a reason), strikes and
    /// toe-offs are those of the whole clip, in seconds from the file's first frame, null where the clip begins or ends
    /// within the contact; and `refused[] {file, clip, reason}`; of a database also `examples[] {name, source, clip,
    /// window_s, mirrored, speed_mps, turn_rate_rad_s, strafe_mps, duration_s, key_times_s, planted_slide_cm_s,
    /// planted_share}`, `velocity_hull {construction, turning_mps[][2], holding_mps[][2],
    /// sharp_turn_edges_mps[][2][2]}`, `blend_space {dimension, simplices[][], covered_share}`, `correspondence
    /// {semi_procedural, blending, pairs_s[][2]}` or null, and `coverage[] {lack, sentence}`: where the set is thin; of
    /// one that breaks an invariant only `broken {invariant, detail}`. Key times: right toe-off, right heel strike,
    /// left toe-off, left heel strike, from right mid-stance.
    #[arg(long)]
    json: bool,
    /// Write pictures of a database: velocity sets, parameters, where they are thin, bodies, steps, and how alike the
    /// poses of m_sp and m_mb are.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Rebuild a database without each of its recorded examples (and its mirror), blend at its parameters, and compare:
    /// root-mean-square distance over the cycle, of all joints and of each by itself, beside that of the nearest other
    /// example. In JSON `leave_one_out {examples[] {name, blended_rmse_m, nearest_rmse_m, joint_blended_rmse_m[22],
    /// joint_nearest_rmse_m[22], nearest, mix[] {name, share}}, outside[], blended_better_share, median_blended_rmse_m,
    /// median_nearest_rmse_m, median_joint_blended_rmse_m, median_joint_nearest_rmse_m, per_joint[] {joint,
    /// median_blended_rmse_m, median_nearest_rmse_m}}`; `joint_…` in the order of `per_joint`; `median_joint_…` over
    /// all joints of all examples; `outside` are corners of the hull, which nothing else reaches.
    #[arg(long)]
    leave_one_out: bool,
    /// Where synthesis could switch between any two examples of a database: times at which their poses (places and
    /// velocities of the joints) are alike. In JSON `correspondence_between {from, to, pairs_s[][2], distances_m[]}`;
    /// with --plots also a picture of that pair's distances. A body that stands has no steps: each step of the other
    /// meets some time of standing.
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"])]
    correspondence: Option<Vec<String>>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    match args.input.as_slice() {
        [database] if is_database(database) => inspect_database(args, database),
        inputs if inputs.iter().any(|input| is_database(input)) => {
            Err(Failure::bad("a database is shown alone; inspect one at a time, and clips by themselves"))
        }
        clips => {
            clips.iter().try_for_each(|path| check_kind(path))?;
            inspect_clips(args, clips)
        }
    }
}

/// That a file may be one of clips; whether there is any is seen when it is read.
fn check_kind(path: &Path) -> Result<(), Failure> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if !path.is_file() || ["bvh", "glb", "gltf", "toml"].contains(&extension.as_str()) {
        return Ok(());
    }
    let what = match extension.as_str() {
        "fbrec" => "a recording; `fbcrowd measure` and `fbcrowd render` show it",
        _ => "neither a database (*.fbdb) nor a clip (*.bvh, *.glb, *.gltf)",
    };
    Err(Failure::bad(format!("{}: {what}", path.display())))
}

fn is_database(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "fbdb")
}

fn inspect_database(args: &Args, path: &Path) -> Result<Answer, Failure> {
    let db = match database_file::load(path) {
        Ok((db, _)) => db,
        // It could be read, and the answer is no.
        Err(broken @ FileError::Invariant { .. }) => return say_broken(args, &broken),
        Err(unreadable) => return Err(unreadable.into()),
    };
    let between = args.correspondence.as_ref().map(|names| Between::new(&db, names)).transpose()?;
    if let Some(folder) = &args.plots {
        let pictures = write_database_plots(&db, folder)?;
        for picture in
            pictures.into_iter().chain(between.as_ref().map(|between| between.draw(&db, folder)).transpose()?)
        {
            output::say(&format!("drew {}", picture.display()));
        }
    }
    let mut report = DatabaseReport::new(&db);
    report.correspondence_between = between;
    report.leave_one_out = args.leave_one_out.then(|| leave_one_out(&db));
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&report::database_text(&db, &report))?;
    }
    Ok(Answer::Yes)
}

fn say_broken(args: &Args, broken: &FileError) -> Result<Answer, Failure> {
    if let (true, FileError::Invariant { invariant, detail, .. }) = (args.json, broken) {
        output::print_json(&serde_json::json!({ "broken": { "invariant": invariant, "detail": detail } }))?;
    }
    output::say(&broken.to_string());
    Ok(Answer::No)
}

fn inspect_clips(args: &Args, clips: &[PathBuf]) -> Result<Answer, Failure> {
    if args.plots.is_some() {
        return Err(Failure::bad("--plots draws databases; compile the clips first with `fbcrowd compile`"));
    }
    if args.leave_one_out {
        let message = "--leave-one-out takes a database apart; compile the clips first with `fbcrowd compile`";
        return Err(Failure::bad(message));
    }
    if args.correspondence.is_some() {
        let message =
            "--correspondence compares examples of a database; compile the clips first with `fbcrowd compile`";
        return Err(Failure::bad(message));
    }
    let ClipSet { clips, rejected } = compiling::import(clips)?;
    compiling::say_refused(&rejected);
    let (is_empty, answer) = (clips.is_empty(), compiling::answer(&rejected));
    let surveyed = survey(clips);
    if args.json {
        output::print_json(&SourcesReport::new(&surveyed, rejected))?;
    } else if !is_empty {
        output::print(&report::sources_text(&surveyed))?;
    }
    if is_empty {
        return Err(Failure::bad(NO_HUMAN));
    }
    Ok(answer)
}

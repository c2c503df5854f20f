//! `fbcrowd inspect`: what a database holds, or what clips are, as a table, JSON and pictures.

use std::path::{Path, PathBuf};

use fbcrowd_render::database_plots::write_database_plots;
use motiondb::file;
use motiondb_compiler::compile;

use crate::compiling;
use crate::failure::{Answer, Failure};
use crate::output;
use crate::report::{self, DatabaseReport, SourcesReport};

/// Show what a database holds, or what was found in clips.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd inspect motion.fbdb --plots out/plots\n  fbcrowd inspect my/clips --json")]
pub(crate) struct Args {
    /// A database, or clips: files or folders.
    #[arg(required = true, value_name = "FILE.fbdb|CLIPS")]
    input: Vec<PathBuf>,
    /// Print JSON: `sources[] {file, clip, speed_mps, turn_rate_rad_s, strafe_mps, up_axis, metres_per_unit,
    /// frame_rate_hz, warnings[]}`; of a database also `examples[] {name, source, clip, mirrored, speed_mps,
    /// turn_rate_rad_s, strafe_mps, duration_s, key_times_s, planted_slide_cm_s, planted_share}`, `velocity_hull
    /// {turning_mps[][2], holding_mps[][2], sharp_turn_edges_mps[][2][2]}`, `blend_space {dimension, simplices[][],
    /// covered_share}` and `correspondence {semi_procedural, blending, pairs_s[][2]}` or null. Key times: right
    /// toe-off, right heel strike, left toe-off, left heel strike, from right mid-stance.
    #[arg(long)]
    json: bool,
    /// Write pictures of a database's velocity sets, examples and simplices.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    match args.input.as_slice() {
        [database] if database.extension().is_some_and(|extension| extension == "fbdb") => {
            inspect_database(args, database)
        }
        clips => inspect_clips(args, clips),
    }
}

fn inspect_database(args: &Args, path: &Path) -> Result<Answer, Failure> {
    let (db, _) = file::load(path)?;
    if let Some(folder) = &args.plots {
        for picture in write_database_plots(&db, folder)? {
            output::say(&format!("drew {}", picture.display()));
        }
    }
    let report = DatabaseReport::new(&db);
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&report::database_text(&report))?;
    }
    Ok(Answer::Yes)
}

fn inspect_clips(args: &Args, clips: &[PathBuf]) -> Result<Answer, Failure> {
    if args.plots.is_some() {
        return Err(Failure::bad("--plots draws databases; compile the clips first with `fbcrowd compile`"));
    }
    let (clips, answer) = compiling::import(clips)?;
    let report = SourcesReport { sources: compile::survey(clips) };
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&report::sources_text(&report.sources))?;
    }
    Ok(answer)
}

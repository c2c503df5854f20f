//! `fbcrowd compile`: clips in, motion database out.

use std::io::{self, IsTerminal};
use std::num::NonZeroUsize;
use std::path::PathBuf;

use motiondb::files::database_file;
use motiondb::velocity_sets::velocity_hull::Construction;
use motiondb_compiler::compile::Compiled;

use crate::compile_report::CompileReport;
use crate::compiling::{self, Overrides};
use crate::failure::{Answer, Failure};
use crate::stages::Stopwatch;
use crate::{compile_text, output};

/// Compile motion clips into a database.
///
/// Units, axes, joints, cycles and parameters are found; a manifest overrides what it names. Exit code 0: all clips
/// were used; 1: the database was written, but some input was refused; 2: nothing was written.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd compile assets/clips -o motion.fbdb\n  fbcrowd compile walk.bvh run.glb -o motion.fbdb\n  \
                  fbcrowd compile clips/manifest.toml -o motion.fbdb --strict"
)]
pub(crate) struct Args {
    /// BVH, GLB or glTF files, folders of them (with their `manifest.toml`), or one manifest.
    #[arg(required = true, value_name = "CLIPS")]
    clips: Vec<PathBuf>,
    /// The database.
    #[arg(short, long, value_name = "FILE.fbdb")]
    output: PathBuf,
    /// Write nothing where any input is refused.
    #[arg(long)]
    strict: bool,
    /// Print the report as JSON, with exit code 2 too: `output` (null where nothing was written), `example_count,
    /// mirror_count, simplex_count, refused[] {file, clip, reason}, unused[] {file, clip, reason}` (human clips that
    /// give no example), `warnings[] {file, clip, note, text}` (a note asks for nothing), `diagnostics[] {file, clip,
    /// severity, code, arguments, text}` (of all human clips; severity is "note", "warning" or "no_example"), `used[] {file, clip,
    /// examples[] {name, mirrored, window_s, speed_mps, turn_rate_rad_s, strafe_mps}}`, `quality[] {example,
    /// planted_slide_cm_s, planted_share, seam_angle_ratio, seam_velocity_ratio, penetration_mm, knee_flexion_min_deg,
    /// leg_extension_max, range_excess_deg, range_excess_joint}`, `findings[] {example, measure, value, threshold,
    /// unit, sentence}`, `coverage[] {lack, sentence}`, `stages[] {name, seconds}`, `next[]`.
    #[arg(long)]
    json: bool,
    /// Most examples, mirrors not counted, whatever the manifest says: m_sp, one that stands and those that reach
    /// farthest come first.
    #[arg(long, value_name = "N", value_parser = from_one_on)]
    max_examples: Option<NonZeroUsize>,
    /// How the motions bound velocities, whatever the manifest says.
    #[arg(long, value_enum, value_name = "SETS")]
    velocity_hull: Option<VelocitySets>,
}

fn from_one_on(text: &str) -> Result<NonZeroUsize, &'static str> {
    text.parse().map_err(|_| "a whole number from 1 on is wanted")
}

/// [`Construction`] on the command line.
#[derive(Clone, Copy, clap::ValueEnum)]
enum VelocitySets {
    /// A set for bodies that turn and one for bodies that hold their facing.
    TurningAndHolding,
    /// The paper's own construction alone: side-stepping and backward motions bound nothing.
    Paper,
}

impl From<VelocitySets> for Construction {
    fn from(sets: VelocitySets) -> Self {
        match sets {
            VelocitySets::TurningAndHolding => Self::TurningAndHolding,
            VelocitySets::Paper => Self::Paper,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let overrides =
        Overrides { velocity_hull: args.velocity_hull.map(Construction::from), max_examples: args.max_examples };
    let stopwatch = Stopwatch::default();
    let compiled = compiling::compile(&args.clips, &args.output, &overrides, &stopwatch);
    if let Err(Failure::NoExample { rejected, sources }) = &compiled
        && args.json
    {
        output::print_json(&CompileReport::without_examples(rejected.clone(), sources))?;
    }
    let compiled = compiled?;
    let answer = compiling::answer(&compiled.rejected);
    if args.strict && answer == Answer::No {
        return refuse(args, compiled, &stopwatch);
    }
    // On a terminal the report says it.
    if !io::stdout().is_terminal() {
        compiling::say_refused(&compiled.rejected);
    }
    stopwatch.begin("writing");
    database_file::write(&args.output, &compiled.db)?;
    let report = CompileReport::new(Some(&args.output), &compiled.db, compiled.rejected, stopwatch.finish());
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&compile_text::text(&report))?;
    }
    Ok(answer)
}

/// Says what was refused, and that it is final.
fn refuse(args: &Args, Compiled { db, rejected }: Compiled, stopwatch: &Stopwatch) -> Result<Answer, Failure> {
    compiling::say_refused(&rejected);
    if args.json {
        output::print_json(&CompileReport::new(None, &db, rejected, stopwatch.finish()))?;
    }
    Err(Failure::bad("some input was refused, and --strict allows none; repair it or leave it out"))
}

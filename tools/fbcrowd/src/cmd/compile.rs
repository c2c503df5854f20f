//! `fbcrowd compile`: clips in, motion database out.

use std::path::PathBuf;

use motiondb::velocity_hull::Construction;
use motiondb::{coverage, file};

use crate::compiling::{self, Overrides};
use crate::failure::{Answer, Failure};
use crate::output;

/// Compile motion clips into a database.
///
/// Units, axes, joints, cycles and parameters are found; a manifest overrides what it names. Exit code 0: all clips were
/// used; 1: the database was written, but some input was refused; 2: nothing was written.
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
    /// How the motions bound velocities, whatever the manifest says.
    #[arg(long, value_enum, value_name = "SETS")]
    velocity_hull: Option<VelocitySets>,
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
    output::spare(&args.output, args.clips.iter().map(PathBuf::as_path))?;
    let overrides = Overrides { velocity_hull: args.velocity_hull.map(Construction::from) };
    let (db, answer) = compiling::compile(&args.clips, &overrides)?;
    if args.strict && answer == Answer::No {
        return Err(Failure::bad("some input was refused, and --strict allows none; repair it or leave it out"));
    }
    file::write(&args.output, &db)?;
    for source in &db.sources {
        for warning in &source.warnings {
            output::say(&format!("warning: {} {}: {warning}", source.file, source.clip));
        }
    }
    for thin in coverage::coverage(&db) {
        output::say(&format!("note: {}", thin.sentence));
    }
    let mirrors = db.examples.iter().filter(|example| example.mirrored).count();
    output::print(&format!(
        "{}: {} examples ({mirrors} of them mirrored) from {} clips, {} simplices",
        args.output.display(),
        db.examples.len(),
        db.sources.len(),
        db.blend_space.simplices().count(),
    ))?;
    Ok(answer)
}

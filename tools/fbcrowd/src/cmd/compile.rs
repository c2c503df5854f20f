//! `fbcrowd compile`: clips in, motion database out; or a figure in, character out.

use std::io::{self, IsTerminal};
use std::num::NonZeroUsize;
use std::path::PathBuf;

use fbcrowd_jobs::character::{self, is_compiled};
use fbcrowd_jobs::compiling::{self, Overrides};
use fbcrowd_jobs::output_path::check_file;
use fbcrowd_jobs::stages::Stopwatch;
use fbcrowd_jobs::{JobError, JobEvent};
use motiondb::velocity_sets::velocity_hull::Construction;
use motiondb_compiler::Compiled;

use crate::cmd::outside_arg::OutsideArg;
use crate::cmd::rejected;
use crate::report::character_report::{CharacterInspection, CharacterReport};
use crate::report::compile_report::CompileReport;
use crate::report::compile_text;
use crate::report::next_steps::with_next_steps;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Compile motion clips into a database, or a figure into a character.
///
/// An output that ends in `.fbchar` is a character, made of one GLB, glTF or VRM file; docs/characters.md describes it.
///
/// The compiler detects units, axes, joints, cycles and parameters; a manifest overrides them. Exit code 0: all clips
/// were used; 1: the database was written, but some input was rejected; 2: nothing was written.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd compile assets/clips -o motion.fbdb\n  fbcrowd compile walk.bvh run.glb -o motion.fbdb\n  \
                  fbcrowd compile clips/manifest.toml -o motion.fbdb --strict\n  fbcrowd compile library -o motion.fbdb --cache library.cache\n  fbcrowd compile figure.glb -o figure.fbchar"
)]
pub(crate) struct Args {
    /// BVH, GLB or glTF files, folders of them (with their `manifest.toml`), or one manifest; or one figure.
    #[arg(required = true, value_name = "CLIPS")]
    clips: Vec<PathBuf>,
    /// The database or character to write.
    #[arg(short, long, value_name = "FILE.fbdb|FILE.fbchar")]
    output: PathBuf,
    /// Write nothing if any input is rejected.
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    outside: OutsideArg,
    /// Keep the analysis of each clip in this folder: the next compilation takes as long as the clips that changed. The
    /// folder is created, and can be deleted at any time; the database is the same with and without it.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Print the report as JSON, with exit code 2 too; docs/json.md describes it.
    #[arg(long)]
    json: bool,
    /// Maximum number of examples, without mirrored ones; overrides the manifest. Kept first: the base walk (m_sp), one
    /// standing example, then the examples with extreme speeds and turn rates.
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    max_examples: Option<NonZeroUsize>,
    /// Use only the clips of a style, stated in the manifest or found in the clips' paths; can be given several times.
    #[arg(long, value_name = "NAME")]
    style: Vec<String>,
    /// Leave out a mesh of a character, by its name as `fbcrowd inspect` lists it; can be given several times.
    #[arg(long, value_name = "MESH")]
    hide: Vec<String>,
    /// How velocity limits are computed from the examples; overrides the manifest.
    #[arg(long, value_enum, value_name = "SETS")]
    velocity_hull: Option<VelocitySets>,
}

fn at_least_one(text: &str) -> Result<NonZeroUsize, &'static str> {
    text.parse().map_err(|_| "not a whole number from 1 on")
}

/// [`Construction`] on the command line.
#[derive(Clone, Copy, clap::ValueEnum)]
enum VelocitySets {
    /// One set for bodies that turn, and one for bodies that hold their facing.
    TurningAndHolding,
    /// The paper's construction: side-steps and backward steps are ignored.
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
    if is_compiled(&args.output) {
        return compile_figure(args);
    }
    if !args.hide.is_empty() {
        return Err(Failure::bad("--hide is an option of characters; leave it out, or write a *.fbchar"));
    }
    let overrides = Overrides {
        velocity_hull: args.velocity_hull.map(Construction::from),
        max_examples: args.max_examples,
        styles: args.style.clone(),
        outside: args.outside.into(),
        cache: args.cache.clone(),
    };
    let (stopwatch, progress) = (Stopwatch::default(), ProgressDisplay::default());
    let observer = |event: JobEvent<'_>| {
        stopwatch.observe(event);
        progress.observe(event);
    };
    check_file(&args.output)?;
    let compiled = compiling::compile(&args.clips, &args.output, &overrides, &observer);
    if let (true, Err(JobError::NoExample { rejected, sources })) = (args.json, &compiled) {
        output::print_json(&with_next_steps(CompileReport::without_examples(rejected.clone(), sources)))?;
    }
    let Compiled { db, rejected, unstyled_manners } = compiled?;
    rejected::print_passed_over(&args.clips)?;
    let answer = rejected::answer(&rejected);
    if args.strict && answer == Answer::No {
        rejected::print(&rejected);
        if args.json {
            let report = CompileReport::new(None, &db, rejected, stopwatch.stage_times());
            output::print_json(&with_next_steps(CompileReport { unstyled_manners, ..report }))?;
        }
        return Err(Failure::bad("some input was rejected, and --strict allows none; repair it or leave it out"));
    }
    // On a terminal the report lists the rejected clips.
    if !io::stdout().is_terminal() {
        rejected::print(&rejected);
    }
    compiling::write_database(&args.output, &db, &observer)?;
    let report = CompileReport::new(Some(&args.output), &db, rejected, stopwatch.stage_times());
    let report = with_next_steps(CompileReport { unstyled_manners, ..report });
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&compile_text::text(&report))?;
    }
    Ok(answer)
}

/// Compiles a character.
fn compile_figure(args: &Args) -> Result<Answer, Failure> {
    let [input] = args.clips.as_slice() else {
        return Err(Failure::bad("a character is made of one file; name one GLB, glTF or VRM file"));
    };
    if args.max_examples.is_some() || args.velocity_hull.is_some() || !args.style.is_empty() || args.cache.is_some() {
        return Err(Failure::bad(
            "--max-examples, --velocity-hull, --style and --cache are options of databases; leave them out",
        ));
    }
    let progress = ProgressDisplay::default();
    check_file(&args.output)?;
    let loaded = character::compile(input, &args.output, args.outside.into(), &args.hide, &|event| {
        progress.observe(event);
    })?;
    let report = CharacterReport::new(input, &loaded);
    if args.json {
        output::print_json(&CharacterInspection { character: report })?;
    } else {
        output::print(&format!("{}{:<20}{}\n", report.text(), "written to", args.output.display()))?;
    }
    Ok(Answer::Yes)
}

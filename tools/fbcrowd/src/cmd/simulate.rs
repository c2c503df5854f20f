//! `fbcrowd simulate`: a scenario on a database, recorded.

use std::io::Write;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::camera_file;
use fbcrowd_jobs::character::ScenarioCharacters;
use fbcrowd_jobs::output_path::{check_file, check_is_no_input, is_same_file};
use fbcrowd_jobs::simulation::{self, SimulationInput};
use fbcrowd_jobs::timings::Timings;
use fbcrowd_jobs::{JobError, JobEvent};
use fbcrowd_sim::scenario::{self, MotionSource};
use motiondb::files::atomic_file::AtomicFile;
use motiondb::files::database_file;

use crate::cmd::outside_arg::OutsideArg;
use crate::report::crowd::timings_text;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Simulate a scenario on a compiled database.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  fbcrowd simulate assets/scenarios/crossing.toml --db motion.fbdb -o crossing.fbrec"
)]
pub(crate) struct Args {
    /// The scenario.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Motion database; overrides the scenario's.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// The recording to write.
    #[arg(short, long, value_name = "FILE.fbrec")]
    output: PathBuf,
    /// Write the durations of the stages as JSON; docs/json.md describes it.
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    #[command(flatten)]
    outside: OutsideArg,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (mut scenario, motion) = scenario::read(&args.scenario)?;
    let camera_files = camera_file::files(&scenario, &args.scenario);
    camera_file::resolve(&mut scenario, &args.scenario, args.outside.into())?;
    let database = match &args.database {
        Some(given) => given.clone(),
        None => own_database(&args.scenario, motion?)?,
    };
    if args.report.as_ref().is_some_and(|report| is_same_file(report, &args.output)) {
        return Err(JobError::OneFileTwice { output: args.output.clone(), first: "recording", second: "report" }.into());
    }
    let progress = ProgressDisplay::default();
    let observer = |event: JobEvent<'_>| progress.observe(event);
    let characters = ScenarioCharacters::load(&args.scenario, &scenario, args.outside.into(), &observer)?;
    let agent_files = scenario::agent_files(&args.scenario)?;
    let inputs =
        [vec![args.scenario.clone(), database.clone()], agent_files, camera_files, characters.files.clone()].concat();
    let worn = characters.outputs(&args.output);
    for written in [Some(&args.output), args.report.as_ref()].into_iter().flatten().chain(&worn) {
        check_is_no_input(written, &inputs)?;
        // The folder of characters need not exist.
        if !worn.contains(written) {
            check_file(written)?;
        }
    }
    let (db, database_checksum) = database_file::load(&database)?;
    scenario::check_styles(&args.scenario, &db.style_names())?;
    // Created before the long work, so that a path that cannot be written ends it early.
    let report = args.report.as_deref().map(TimingsFile::create).transpose()?;
    characters.note(&db.skeleton, &observer);
    characters.wear(&mut scenario, &db.skeleton);
    characters.write(&args.output)?;
    let input = SimulationInput { db, database_checksum, scenario, character_checksums: characters.checksums() };
    let timings = simulation::simulate(input, &args.output, &observer)?;
    report.map_or(Ok(()), |report| report.finish(&timings))?;
    output::print(&timings_text::text(&timings))?;
    Ok(Answer::Yes)
}

/// The database that the scenario itself names.
fn own_database(scenario: &Path, motion: MotionSource) -> Result<PathBuf, Failure> {
    match motion {
        MotionSource::Database(own) => Ok(own),
        MotionSource::Clips(clips) => Err(Failure::bad(format!(
            "{} names clips, not a database; compile {} and name the result with --db, or use `fbcrowd run`",
            scenario.display(),
            clips.display()
        ))),
    }
}

/// The file of `--report`.
struct TimingsFile<'a> {
    path: &'a Path,
    file: AtomicFile,
}

impl<'a> TimingsFile<'a> {
    fn create(path: &'a Path) -> Result<Self, Failure> {
        let file = AtomicFile::create(path).map_err(|error| Failure::unwritable(path, error))?;
        Ok(Self { path, file })
    }

    fn finish(mut self, timings: &Timings) -> Result<(), Failure> {
        let written = self.file.writer().write_all(output::to_json(timings).as_bytes());
        written.and_then(|()| self.file.commit()).map_err(|error| Failure::unwritable(self.path, error))
    }
}

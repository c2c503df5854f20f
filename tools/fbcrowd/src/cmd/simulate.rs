//! `fbcrowd simulate`: a scenario on a database, recorded.

use std::io::Write;
use std::path::{Path, PathBuf};

use fbcrowd_sim::scenario::{self, MotionSource};
use motiondb::files::atomic_file::AtomicFile;
use motiondb::files::database_file;

use crate::failure::{Answer, Failure};
use crate::output;
use crate::simulation::{self, Timings};

/// Simulate a scenario on a compiled database.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  fbcrowd simulate assets/scenarios/crossing.toml --db motion.fbdb -o crossing.fbrec"
)]
pub(crate) struct Args {
    /// The scenario.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// The database; by default the one that the scenario names, which needs no motion of its own where this is given.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// The recording.
    #[arg(short, long, value_name = "FILE.fbrec")]
    output: PathBuf,
    /// Write where the time went, as JSON: `agents, steps, threads, plan_microseconds_per_agent_step, synthesis_…,
    /// coupling_…, times_real_time, agents_per_core_in_real_time`; path and neighbours count as planning.
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (scenario, motion) = scenario::read(&args.scenario)?;
    let database = match &args.database {
        Some(given) => given.clone(),
        None => own_database(&args.scenario, motion?)?,
    };
    if args.report.as_ref().is_some_and(|report| output::is_same_place(report, &args.output)) {
        let file = args.output.display();
        return Err(Failure::bad(format!("{file} cannot be both recording and report; give --report another name")));
    }
    let inputs = [vec![args.scenario.clone(), database.clone()], scenario::agent_files(&args.scenario)?].concat();
    for written in [Some(&args.output), args.report.as_ref()].into_iter().flatten() {
        output::spare(written, &inputs)?;
    }
    let (db, checksum) = database_file::load(&database)?;
    // Opened before the long work, so that a place that cannot be written ends it early.
    let report = args.report.as_deref().map(Report::create).transpose()?;
    let timings = simulation::simulate(db, checksum, scenario, &args.output)?;
    report.map_or(Ok(()), |report| report.finish(&timings))?;
    output::print(&timings.text())?;
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
struct Report<'a> {
    path: &'a Path,
    file: AtomicFile,
}

impl<'a> Report<'a> {
    fn create(path: &'a Path) -> Result<Self, Failure> {
        let file = AtomicFile::create(path).map_err(|error| Failure::unwritable(path, &error))?;
        Ok(Self { path, file })
    }

    fn finish(mut self, timings: &Timings) -> Result<(), Failure> {
        let written = self.file.writer().write_all(output::to_json(timings).as_bytes());
        written.and_then(|()| self.file.commit()).map_err(|error| Failure::unwritable(self.path, &error))
    }
}

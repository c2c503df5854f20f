//! `fbcrowd simulate`: a scenario on a database, recorded.

use std::path::PathBuf;

use fbcrowd_sim::scenario_file::MotionSource;
use motiondb::{atomic_file, file};

use crate::failure::{Answer, Failure};
use crate::{output, simulation};

/// Simulate a scenario on a compiled database.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  fbcrowd simulate assets/scenarios/crossing.toml --db motion.fbdb -o crossing.fbrec"
)]
pub(crate) struct Args {
    /// The scenario.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// The database; the scenario's own by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// The recording.
    #[arg(short, long, value_name = "FILE.fbrec")]
    output: PathBuf,
    /// Write the time that each stage took, as JSON.
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (scenario, motion) = simulation::read_scenario(&args.scenario)?;
    let database = match (&args.database, motion) {
        (Some(given), _) => given.clone(),
        (None, MotionSource::Database(own)) => own,
        (None, MotionSource::Clips(clips)) => {
            return Err(Failure::bad(format!(
                "{} names clips, not a database; compile {} and name the result with --db, or use `fbcrowd run`",
                args.scenario.display(),
                clips.display()
            )));
        }
    };
    let (db, checksum) = file::load(&database)?;
    let timings = simulation::simulate(db, checksum, scenario, &args.output)?;
    if let Some(report) = &args.report {
        atomic_file::write(report, output::to_json(&timings).as_bytes())
            .map_err(|error| Failure::unwritable(report, &error))?;
    }
    output::print(&timings.text())?;
    Ok(Answer::Yes)
}

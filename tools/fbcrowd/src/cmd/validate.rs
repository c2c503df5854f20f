//! `fbcrowd validate`: every invariant of a database, and the quality of its motion.

use std::path::PathBuf;

use motiondb::files::database_file;

use crate::report::validation_report::ValidationReport;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Check every invariant of a motion database, and the quality of its motion.
///
/// Exit code 0: all invariants hold; 1: one is broken, or with --strict a quality value exceeds its threshold; 2: the
/// file cannot be read as a database (the message names what is wrong: magic number, version, length, checksum or
/// content).
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd validate out/antipodal/motion.fbdb\n  fbcrowd validate motion.fbdb --strict --json"
)]
pub(crate) struct Args {
    /// The database.
    #[arg(value_name = "FILE.fbdb")]
    database: PathBuf,
    /// Print JSON; docs/json.md describes it.
    #[arg(long)]
    json: bool,
    /// Exit with 1 also if a quality value exceeds its threshold.
    #[arg(long)]
    strict: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (db, _) = database_file::read(&args.database)?;
    let report = ValidationReport::new(&db);
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&report.text())?;
    }
    Ok(Answer::of(report.valid && (report.findings.is_empty() || !args.strict)))
}

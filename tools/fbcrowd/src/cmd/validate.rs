//! `fbcrowd validate`: every invariant of a database, by name.

use std::path::PathBuf;

use motiondb::validate::Check;
use serde::Serialize;

use crate::failure::{Answer, Failure};
use crate::output;

/// Check every invariant of a motion database.
///
/// Exit code 0: all hold; 1: one is broken; 2: the file is no readable database.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd validate out/antipodal/motion.fbdb --json")]
pub(crate) struct Args {
    /// The database.
    #[arg(value_name = "FILE.fbdb")]
    database: PathBuf,
    /// Print `{valid, checks[] {name, holds, detail}}`.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    valid: bool,
    checks: Vec<Line>,
}

#[derive(Serialize)]
struct Line {
    name: &'static str,
    holds: bool,
    detail: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let (db, _) = motiondb::file::read(&args.database)?;
    let line = |check: Check| Line { name: check.name, holds: check.broken.is_none(), detail: check.broken };
    let checks: Vec<Line> = motiondb::validate::validate(&db).into_iter().map(line).collect();
    let report = Report { valid: checks.iter().all(|check| check.holds), checks };
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&text(&report))?;
    }
    Ok(if report.valid { Answer::Yes } else { Answer::No })
}

fn text(report: &Report) -> String {
    let line = |check: &Line| match &check.detail {
        None => format!("holds   {}\n", check.name),
        Some(detail) => format!("BROKEN  {}: {detail}\n", check.name),
    };
    report.checks.iter().map(line).collect()
}

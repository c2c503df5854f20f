//! `fbcrowd validate`: every invariant of a database, by name, and what of its motion a person should look at.

use std::path::PathBuf;

use motiondb::quality::example_quality::{self, ExampleQuality, Finding};
use motiondb::validate::{self, Check};
use serde::Serialize;

use crate::failure::{Answer, Failure};
use crate::output;

/// Check every invariant of a motion database, and how good its motion is.
///
/// Exit code 0: all invariants hold; 1: one is broken, or with --strict a figure is beyond its threshold; 2: the file
/// is no readable database (the message names what is wrong: its mark, version, length, checksum or content).
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd validate out/antipodal/motion.fbdb\n  fbcrowd validate motion.fbdb --strict --json"
)]
pub(crate) struct Args {
    /// The database.
    #[arg(value_name = "FILE.fbdb")]
    database: PathBuf,
    /// Print `{valid, checks[] {name, holds, detail}, findings[] {example, measure, value, threshold, unit, sentence},
    /// quality[] {example, planted_slide_cm_s, planted_share, seam_angle_ratio, seam_velocity_ratio, penetration_mm,
    /// knee_flexion_min_deg, leg_extension_max, range_excess_deg, range_excess_joint}}`: invariants; figures beyond
    /// their thresholds (mirrors are passed over); all figures, mirrors too. A seam is measured in the cycle's own
    /// median step; a leg's extension in its length. Where an invariant is broken there are no figures.
    #[arg(long)]
    json: bool,
    /// Answer no where a figure is beyond its threshold, too.
    #[arg(long)]
    strict: bool,
}

#[derive(Serialize)]
struct Report {
    valid: bool,
    checks: Vec<Line>,
    findings: Vec<Finding>,
    quality: Vec<ExampleQuality>,
}

#[derive(Serialize)]
struct Line {
    name: &'static str,
    holds: bool,
    detail: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    // Whatever can be read has the right mark, version, length and checksum.
    let (db, _) = motiondb::files::database_file::read(&args.database)?;
    let checksum = Check { name: "checksum", broken: None };
    let line = |check: Check| Line { name: check.name, holds: check.broken.is_none(), detail: check.broken };
    let checks: Vec<Line> = [checksum].into_iter().chain(validate::validate(&db)).map(line).collect();
    let valid = checks.iter().all(|check| check.holds);
    // Figures of an unsound database mean nothing.
    let (findings, quality) =
        if valid { (example_quality::lint(&db), example_quality::quality(&db)) } else { Default::default() };
    let report = Report { valid, checks, findings, quality };
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&text(&report))?;
    }
    let is_yes = report.valid && (report.findings.is_empty() || !args.strict);
    Ok(if is_yes { Answer::Yes } else { Answer::No })
}

fn text(report: &Report) -> String {
    let check = |check: &Line| match &check.detail {
        None => format!("holds    {}\n", check.name),
        Some(detail) => format!("BROKEN   {}: {detail}\n", check.name),
    };
    let finding = |finding: &Finding| format!("warning  {}: {}\n", finding.example, finding.sentence);
    report.checks.iter().map(check).chain(report.findings.iter().map(finding)).collect()
}

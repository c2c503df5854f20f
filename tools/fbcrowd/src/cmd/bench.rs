//! `fbcrowd bench`: measures, and compares the measurements with what a release must meet.

use fbcrowd_bench::Bench;

use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Run one bench and compare its measurements with the release criteria.
///
/// Durations and sizes depend on the machine; they are printed with a goal, but do not change the exit code. Exit code
/// 0: every criterion is met; 1: one is missed; 2: the input cannot be read.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench compile --mocap my/clips\n  fbcrowd bench table1 --json")]
pub(crate) struct Args {
    #[command(subcommand)]
    bench: Bench,
    /// Print JSON; docs/json.md describes it.
    #[arg(long, global = true)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let progress = ProgressDisplay::default();
    let report = args.bench.run(&|event| progress.observe(event))?;
    output::print(if args.json { &report.json } else { &report.text })?;
    Ok(Answer::of(report.all_met))
}

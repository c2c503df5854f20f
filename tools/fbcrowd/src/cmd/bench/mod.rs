//! `fbcrowd bench`: are compiler and planner as good and as fast as they should be? One file a bench.

mod bar;
mod blend;
mod blend_space;
mod bodies;
mod bundled;
mod clips;
mod compile;
mod contest;
mod coupled;
mod course;
mod emergence;
mod figure6;
mod figure6_scene;
mod figure7;
mod gait;
mod import;
mod leave_one_out;
mod plan;
mod quality;
mod quality_errands;
mod quality_measures;
mod quality_walk;
mod reach;
mod rimea;
mod rimea_cases;
mod rimea_more;
mod scenes;
mod soak;
mod table1;
mod table1_discs;
mod table1_plots;
mod table1_text;
mod tracking;
mod walker;
mod watch;

use std::path::PathBuf;

use crate::failure::{Answer, Failure};

/// Measure against the bars that a release must meet.
///
/// Every bench can print JSON: what it measured, then `goals[] {name, measured, goal}` (times and sizes, which depend
/// on the machine) and last `bars[] {name, measured, limit, met}`. Exit code 0: every bar is met; 1: one is missed; 2:
/// what is to be measured cannot be read.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench compile --mocap my/clips\n  fbcrowd bench table1 --json")]
pub(crate) struct Args {
    #[command(subcommand)]
    bench: Bench,
}

// The compiler first, then speed, bodies, crowds, and what is wild.
#[derive(clap::Subcommand)]
enum Bench {
    Import(import::Args),
    Compile(compile::Args),
    LeaveOneOut(leave_one_out::Args),
    Gait(gait::Args),
    Clips(clips::Args),
    BlendSpace(blend_space::Args),
    Plan(plan::Args),
    Bodies(bodies::Args),
    Figure6(figure6::Args),
    Blend(blend::Args),
    Tracking(tracking::Args),
    Reach(reach::Args),
    Quality(quality::Args),
    Table1(table1::Args),
    Figure7(figure7::Args),
    Course(course::Args),
    Coupled(coupled::Args),
    Rimea(rimea::Args),
    Emergence(emergence::Args),
    Soak(soak::Args),
}

/// What every bench on other people's clips is told.
#[derive(clap::Args)]
struct Mocap {
    /// The folder of clips: other people's recordings, which are no part of this repository.
    #[arg(long, value_name = "DIR")]
    mocap: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    match &args.bench {
        Bench::Import(args) => import::run(args),
        Bench::Compile(args) => compile::run(args),
        Bench::LeaveOneOut(args) => leave_one_out::run(args),
        Bench::Gait(args) => gait::run(args),
        Bench::Clips(args) => clips::run(args),
        Bench::BlendSpace(args) => blend_space::run(args),
        Bench::Plan(args) => plan::run(args),
        Bench::Bodies(args) => bodies::run(args),
        Bench::Figure6(args) => figure6::run(args),
        Bench::Blend(args) => blend::run(args),
        Bench::Tracking(args) => tracking::run(args),
        Bench::Reach(args) => reach::run(args),
        Bench::Quality(args) => quality::run(args),
        Bench::Table1(args) => table1::run(args),
        Bench::Figure7(args) => figure7::run(args),
        Bench::Course(args) => course::run(args),
        Bench::Coupled(args) => coupled::run(args),
        Bench::Rimea(args) => rimea::run(args),
        Bench::Emergence(args) => emergence::run(args),
        Bench::Soak(args) => soak::run(args),
    }
}

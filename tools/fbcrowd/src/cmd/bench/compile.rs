//! `fbcrowd bench compile`: how long a whole folder takes, how much memory, and whether the bytes are always the same.

use std::fs;
use std::path::Path;
use std::time::Instant;

use motiondb::files::database_file;
use motiondb_compiler::{Manifest, clip_files, compile};
use serde::Serialize;

use crate::cmd::bench::Mocap;
use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::compile_text::counted;
use crate::failure::{Answer, Failure};
use crate::stages::{Stage, Stopwatch};

/// What the whole development set should take on two cores.
const GOAL_S: f64 = 20.0;
const GOAL_MB: f64 = 500.0;

/// Compile a whole folder, again with one thread and with its files in reversed order.
///
/// In JSON `files, examples, stages[] {name, seconds}`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench compile --mocap my/mocap")]
pub(super) struct Args {
    #[command(flatten)]
    mocap: Mocap,
}

#[derive(Serialize)]
struct Details {
    files: usize,
    examples: usize,
    stages: Vec<Stage>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let folder = &args.mocap.mocap;
    let files = clip_files(folder).map_err(|error| Failure::bad(error.to_string()))?;
    let manifest = Manifest::of_files(&files);
    let (start, stopwatch) = (Instant::now(), Stopwatch::default());
    let compiled = compile::compile_manifest(&manifest, &|event| stopwatch.watch(event))?;
    let bytes = database_file::to_bytes(&compiled.db);
    let (seconds, stages) = (start.elapsed().as_secs_f64(), stopwatch.finish());
    // Before the other compilations add to it.
    let peak_mb = peak_memory_mb();

    let mut reversed = manifest.clone();
    reversed.clips.reverse();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one_thread = one_thread.map_err(|error| Failure::bad(format!("cannot start a thread: {error}")))?;
    let same = [one_thread.install(|| compiled_bytes(&manifest))? == bytes, compiled_bytes(&reversed)? == bytes];
    let found = Found {
        details: Details { files: files.len(), examples: compiled.db.examples.len(), stages },
        goals: vec![
            Goal { name: "seconds", measured: Some(seconds), goal: GOAL_S },
            Goal { name: "peak memory, MB", measured: peak_mb, goal: GOAL_MB },
        ],
        bars: vec![
            Bar::at_least("same bytes with one thread", 1.0, f64::from(same[0])),
            Bar::at_least("same bytes in reversed order", 1.0, f64::from(same[1])),
        ],
    };
    conclude(&found, &text(&found.details, folder), args.mocap.json)
}

fn compiled_bytes(manifest: &Manifest) -> Result<Vec<u8>, Failure> {
    Ok(database_file::to_bytes(&compile::compile_manifest(manifest, &|_| ())?.db))
}

/// The most memory that this process ever held, as Linux tells it.
fn peak_memory_mb() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e6)
}

fn text(details: &Details, folder: &Path) -> String {
    let stages = details.stages.iter().map(|stage| format!("  {:<24}{:6.2} s\n", stage.name, stage.seconds));
    format!(
        "{}: {}, {}\n{}",
        folder.display(),
        counted(details.files, "file", "files"),
        counted(details.examples, "example", "examples"),
        stages.collect::<String>()
    )
}

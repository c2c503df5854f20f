//! `fbcrowd bench compile`: duration and memory of compiling a folder, and whether the bytes are always the same.

use std::fs;
use std::path::Path;
use std::time::Instant;

use fbcrowd_jobs::compiling::forward;
use fbcrowd_jobs::stages::{StageTime, Stopwatch};
use fbcrowd_jobs::wording::counted;
use fbcrowd_jobs::{JobEvent, Observer};
use motiondb::files::database_file;
use motiondb_compiler::{Manifest, compile};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::MocapArg;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::threads::pool;

/// Goal for the whole set of clips on two cores, s.
const GOAL_S: f64 = 20.0;
/// Goal for the peak memory, MB.
const GOAL_MB: f64 = 500.0;

/// Compile a whole folder, again with one thread and with its files in reversed order.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench compile --mocap my/mocap")]
pub struct Args {
    #[command(flatten)]
    mocap: MocapArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Number of files.
    pub files: usize,
    /// Number of examples, mirrored ones included.
    pub examples: usize,
    /// Durations of the compiler's stages.
    pub stages: Vec<StageTime>,
}

/// Runs the bench. It reports no progress: that would take time.
///
/// # Errors
/// If the folder cannot be read, or its clips give no database.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let folder = &args.mocap.mocap;
    let files = motiondb_compiler::clip_files(folder)?;
    let manifest = Manifest::of_files(&files);
    let (start, stopwatch) = (Instant::now(), Stopwatch::default());
    let observer = |event: JobEvent<'_>| stopwatch.observe(event);
    let compiled = compile::compile_manifest(&manifest, &|event| forward(event, &observer))?;
    let bytes = database_file::to_bytes(&compiled.db);
    let (seconds, stages) = (start.elapsed().as_secs_f64(), stopwatch.stage_times());
    // Before the other compilations add to it.
    let peak_mb = peak_memory_mb();

    let mut reversed = manifest.clone();
    reversed.clips.reverse();
    let with_one_thread = pool(1)?.install(|| compiled_bytes(&manifest))? == bytes;
    let in_reversed_order = compiled_bytes(&reversed)? == bytes;
    let details = Details { files: files.len(), examples: compiled.db.examples.len(), stages };
    Ok(BenchReport {
        text: text(&details, folder),
        details,
        goals: vec![
            Goal { name: "seconds", measured: Some(seconds), goal: GOAL_S },
            Goal { name: "peak memory, MB", measured: peak_mb, goal: GOAL_MB },
        ],
        criteria: vec![
            Criterion::at_least("same bytes with one thread", 1.0, f64::from(with_one_thread)),
            Criterion::at_least("same bytes in reversed order", 1.0, f64::from(in_reversed_order)),
        ],
    })
}

fn compiled_bytes(manifest: &Manifest) -> Result<Vec<u8>, BenchError> {
    Ok(database_file::to_bytes(&compile::compile_manifest(manifest, &|_| ())?.db))
}

/// Greatest memory of this process, MB; none where the system is not Linux.
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

//! `fbcrowd bench import`: imports public motion-capture clips, compares the detected parameters with published
//! measurements, and times BVH reading.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::observer::Work;
use motiondb_compiler::ImportedClip;
use schemars::JsonSchema;
use serde::Serialize;

use crate::compiler::ground_truth::{self, GroundTruth};
use crate::compiler::reading_speed::{ReadingTimes, reading_times};
use crate::error::BenchError;
use crate::kit::args::MocapArg;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::statistics::share;

/// Number of reads per file; the median counts.
const READS_PER_FILE: usize = 5;
/// Clips in the text, the worst first; JSON has all.
const SHOWN_CLIPS: usize = 12;
/// Least share of the clips within the tolerances.
const WITHIN_SHARE: f64 = 0.95;
/// Lowest BVH reading speed, relative to `bvh_anim` alone.
const SPEED_RATIO: f64 = 0.7;
/// Goal for reading BVH, MB/s.
const GOAL_MB_S: f64 = 70.0;

/// Import every clip of human locomotion in DIR/index.csv and compare it with the measurements of that file.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench import --mocap my/mocap --json")]
pub struct Args {
    #[command(flatten)]
    mocap: MocapArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Clips of the index, the one that is farthest off first.
    #[serde(rename = "rows")]
    pub clips: Vec<ComparedClip>,
    /// Number of BVH files that were read.
    pub files_read: usize,
    /// Size of these files, MB.
    pub megabytes_read: f64,
}

/// One clip of the index.
#[derive(JsonSchema, Serialize)]
pub struct ComparedClip {
    /// File of the clip, relative to the folder.
    pub file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub clip: String,
    /// Speed m/s, turn rate °/s and side speed m/s that the import found; null where the clip was rejected.
    pub found: Option<[f64; 3]>,
    /// Speed m/s, turn rate °/s and side speed m/s that others measured; null where the clip was rejected.
    pub wanted: Option<[f64; 3]>,
    /// Greatest difference over its tolerance; null where the clip was rejected.
    pub excess: Option<f64>,
    /// Whether the clip counts for the criterion. Rejected clips count as failed; clips too short to judge do not
    /// count.
    pub judged: bool,
    /// Whether up axis and unit are right.
    pub units_hold: bool,
    /// Why the clip was rejected; null where it was not.
    pub refused: Option<String>,
}

/// Runs the bench.
///
/// # Errors
/// If the folder or its `index.csv` cannot be read.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let folder = &args.mocap.mocap;
    let truths =
        ground_truth::read(folder).map_err(|error| BenchError::unreadable(&folder.join("index.csv"), error))?;
    let mut clips = compared(folder, &truths, observer);
    clips.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
    let reading = reading(folder, observer)?;

    let judged = || clips.iter().filter(|clip| clip.judged);
    let within = share(judged(), |clip| clip.distance() <= 1.0);
    let units = share(clips.iter(), |clip| clip.units_hold);
    let speed_ratio = reading.times.alone_s / reading.times.ours_s;
    let criteria = vec![
        Criterion::at_least("share of clips within tolerance", WITHIN_SHARE, within),
        Criterion::at_least("share of clips with the right up axis and unit", 1.0, units),
        Criterion::at_least("speed of reading BVH over bvh_anim alone", SPEED_RATIO, speed_ratio),
    ];
    let megabytes_read = reading.bytes as f64 / 1e6;
    let mb_per_s = Some(megabytes_read / reading.times.ours_s);
    let goals = vec![Goal { name: "reading BVH, MB/s", measured: mb_per_s, goal: GOAL_MB_S }];
    let details = Details { files_read: reading.files, megabytes_read, clips };
    Ok(BenchReport { text: text(&details), details, goals, criteria })
}

impl ComparedClip {
    /// Greatest difference over its tolerance; infinite for a rejected clip.
    fn distance(&self) -> f64 {
        self.excess.unwrap_or(f64::INFINITY)
    }
}

/// Every clip of the index, by file. Each file is read once.
fn compared(folder: &Path, truths: &[GroundTruth], observer: &Observer) -> Vec<ComparedClip> {
    let mut by_file: BTreeMap<&str, Vec<&GroundTruth>> = BTreeMap::new();
    truths.iter().for_each(|truth| by_file.entry(&truth.file).or_default().push(truth));
    let work = Work::begin(observer, "clips", by_file.len());
    let mut clips = Vec::new();
    for (file, truths) in by_file {
        let path = folder.join(file);
        match motiondb_compiler::import_file(&path) {
            Ok(imports) => clips.extend(truths.into_iter().map(|truth| compared_clip(truth, &imports))),
            Err(error) => clips.extend(truths.into_iter().map(|truth| refused(truth, error.to_string()))),
        }
        work.advance();
    }
    work.end();
    clips
}

fn compared_clip(truth: &GroundTruth, imports: &[ImportedClip]) -> ComparedClip {
    let Some(import) = imports.iter().find(|import| import.clip == truth.clip) else {
        return refused(truth, "the file holds no such clip".to_owned());
    };
    let human = match &import.outcome {
        Ok(human) => human,
        Err(refusal) => return refused(truth, refusal.to_string()),
    };
    let judgement = truth.judge(human);
    ComparedClip {
        file: truth.file.clone(),
        clip: truth.clip.clone(),
        found: Some(judgement.found),
        wanted: Some(judgement.wanted),
        excess: Some(judgement.excess()),
        judged: judgement.is_judged,
        units_hold: judgement.units_hold,
        refused: None,
    }
}

fn refused(truth: &GroundTruth, reason: String) -> ComparedClip {
    ComparedClip {
        file: truth.file.clone(),
        clip: truth.clip.clone(),
        found: None,
        wanted: None,
        excess: None,
        judged: true,
        units_hold: false,
        refused: Some(reason),
    }
}

/// Durations of reading all readable BVH files of a folder.
struct Reading {
    times: ReadingTimes,
    files: usize,
    bytes: usize,
}

fn reading(folder: &Path, observer: &Observer) -> Result<Reading, BenchError> {
    let files = motiondb_compiler::clip_files(folder)?;
    let files: Vec<PathBuf> = files.into_iter().filter(|file| file.extension() == Some(OsStr::new("bvh"))).collect();
    let work = Work::begin(observer, "readings", files.len());
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let mut all = Reading { times: ReadingTimes { ours_s: 0.0, alone_s: 0.0 }, files: 0, bytes: 0 };
    for file in &files {
        let bytes = fs::read(file).map_err(|error| BenchError::unreadable(file, error))?;
        if let Ok(ReadingTimes { ours_s, alone_s }) = reading_times(file, &bytes, READS_PER_FILE, &clock) {
            all.times.ours_s += ours_s;
            all.times.alone_s += alone_s;
            all.files += 1;
            all.bytes += bytes.len();
        }
        work.advance();
    }
    work.end();
    Ok(all)
}

fn text(details: &Details) -> String {
    let mut text = "farthest off, in tolerances (found, measured by others; m/s, °/s, m/s)\n".to_owned();
    for clip in details.clips.iter().take(SHOWN_CLIPS) {
        text += &format!("  {:5.2}  {} {}{}\n", clip.distance(), clip.file, clip.clip, verdict(clip));
    }
    text + &format!(
        "\nread {} BVH files, {:.1} MB, the median of {READS_PER_FILE} times each\n",
        details.files_read, details.megabytes_read
    )
}

fn verdict(clip: &ComparedClip) -> String {
    let (Some(found), Some(wanted)) = (clip.found, clip.wanted) else {
        return format!(": {}", clip.refused.clone().unwrap_or_default());
    };
    let units = if clip.units_hold { "" } else { "; other axis or unit" };
    let judged = if clip.judged { "" } else { "; too short to judge" };
    format!(": {found:.2?}, {wanted:.2?}{judged}{units}")
}

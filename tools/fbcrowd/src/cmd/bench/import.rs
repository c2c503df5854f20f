//! `fbcrowd bench import`: other people's clips against what others measured in them, and how fast they are read.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use motiondb_compiler::reading_speed::{self, Race};
use motiondb_compiler::truth::{self, Truth};
use motiondb_compiler::{ImportedClip, clip_files, import_file};
use serde::Serialize;

use crate::cmd::bench::Mocap;
use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::failure::{Answer, Failure};
use crate::progress::Progress;
use crate::statistics::share;

/// Reading each file so often lets the median forget a neighbour's work.
const READINGS: usize = 5;
/// Rows that are shown, worst first; JSON has all.
const SHOWN_ROWS: usize = 12;

/// Import every clip of human locomotion in DIR/index.csv and compare with what stands there.
///
/// In JSON `rows[] {file, clip, found, wanted, excess, judged, units_hold, refused}, files_read, megabytes_read`: found
/// and wanted are (v_f m/s, turn rate °/s, side speed m/s); excess is the greatest difference over its tolerance, null
/// where the clip is refused.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench import --mocap my/mocap --json")]
pub(super) struct Args {
    #[command(flatten)]
    mocap: Mocap,
}

#[derive(Serialize)]
struct Details {
    rows: Vec<Row>,
    files_read: usize,
    megabytes_read: f64,
}

#[derive(Serialize)]
struct Row {
    file: String,
    clip: String,
    found: Option<[f64; 3]>,
    wanted: Option<[f64; 3]>,
    excess: Option<f64>,
    judged: bool,
    units_hold: bool,
    refused: Option<String>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let folder = &args.mocap.mocap;
    let unreadable = |error| Failure::bad(format!("{}/index.csv: {error}", folder.display()));
    let truths = truth::read(folder).map_err(unreadable)?;
    let mut rows = judged(folder, &truths);
    rows.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
    let reading = reading(folder)?;

    let judged = || rows.iter().filter(|row| row.judged);
    let within = share(judged(), |row| row.distance() <= 1.0);
    let units = share(rows.iter(), |row| row.units_hold);
    let bars = vec![
        Bar::at_least("share of clips within tolerance", 0.95, within),
        Bar::at_least("share of clips with the right up axis and unit", 1.0, units),
        Bar::at_least("speed of reading BVH over bvh_anim alone", 0.7, reading.race.alone_s / reading.race.ours_s),
    ];
    let megabytes_read = reading.bytes as f64 / 1e6;
    let mb_per_s = Some(megabytes_read / reading.race.ours_s);
    let goals = vec![Goal { name: "reading BVH, MB/s", measured: mb_per_s, goal: 70.0 }];
    let details = Details { files_read: reading.files, megabytes_read, rows };
    let found = Found { details, goals, bars };
    conclude(&found, &text(&found.details), args.mocap.json)
}

impl Row {
    /// Off by so many tolerances; a refused clip by more than any other.
    fn distance(&self) -> f64 {
        self.excess.unwrap_or(f64::INFINITY)
    }
}

/// Every row of the index, in its order; each file is read once.
fn judged(folder: &Path, truths: &[Truth]) -> Vec<Row> {
    let mut by_file: BTreeMap<&str, Vec<&Truth>> = BTreeMap::new();
    truths.iter().for_each(|truth| by_file.entry(&truth.file).or_default().push(truth));
    let progress = Progress::new("clips", by_file.len());
    let mut rows = Vec::new();
    for (file, truths) in by_file {
        let path = folder.join(file);
        match import_file(&path) {
            Ok(imports) => rows.extend(truths.into_iter().map(|truth| row(truth, &imports))),
            Err(error) => rows.extend(truths.into_iter().map(|truth| refused(truth, error.to_string()))),
        }
        progress.advance();
    }
    progress.finish();
    rows
}

fn row(truth: &Truth, imports: &[ImportedClip]) -> Row {
    let Some(import) = imports.iter().find(|import| import.clip == truth.clip) else {
        return refused(truth, "the file holds no such clip".to_owned());
    };
    let human = match &import.outcome {
        Ok(human) => human,
        Err(refusal) => return refused(truth, refusal.to_string()),
    };
    let judgement = truth.judge(human);
    Row {
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

fn refused(truth: &Truth, reason: String) -> Row {
    Row {
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

/// All BVH files of a folder that can be read.
struct Reading {
    race: Race,
    files: usize,
    bytes: usize,
}

fn reading(folder: &Path) -> Result<Reading, Failure> {
    let files = clip_files(folder).map_err(|error| Failure::bad(error.to_string()))?;
    let files: Vec<PathBuf> = files.into_iter().filter(|file| file.extension() == Some(OsStr::new("bvh"))).collect();
    let progress = Progress::new("readings", files.len());
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let mut all = Reading { race: Race { ours_s: 0.0, alone_s: 0.0 }, files: 0, bytes: 0 };
    for file in &files {
        let bytes = fs::read(file).map_err(|error| Failure::bad(format!("{}: {error}", file.display())))?;
        if let Ok(Race { ours_s, alone_s }) = reading_speed::race(file, &bytes, READINGS, &clock) {
            all.race.ours_s += ours_s;
            all.race.alone_s += alone_s;
            all.files += 1;
            all.bytes += bytes.len();
        }
        progress.advance();
    }
    progress.finish();
    Ok(all)
}

fn text(details: &Details) -> String {
    let mut text = "farthest off, in tolerances (found, measured by others; m/s, °/s, m/s)\n".to_owned();
    for row in details.rows.iter().take(SHOWN_ROWS) {
        text += &format!("  {:5.2}  {} {}{}\n", row.distance(), row.file, row.clip, verdict(row));
    }
    text + &format!(
        "\nread {} BVH files, {:.1} MB, the median of {READINGS} times each\n",
        details.files_read, details.megabytes_read
    )
}

fn verdict(row: &Row) -> String {
    let (Some(found), Some(wanted)) = (row.found, row.wanted) else {
        return format!(": {}", row.refused.clone().unwrap_or_default());
    };
    let units = if row.units_hold { "" } else { "; other axis or unit" };
    let judged = if row.judged { "" } else { "; too short to judge" };
    format!(": {found:.2?}, {wanted:.2?}{judged}{units}")
}

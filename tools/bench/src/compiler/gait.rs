//! `fbcrowd bench gait`: heel strikes and toe-offs against labels that were set by hand.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::Observer;
use motiondb_compiler::retarget::HumanClip;
use motiondb_compiler::survey::{ContactTimes, SourceGait, survey};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::MocapArg;
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::statistics::share;

/// Tolerance of a label, frames of the source; the label's own uncertainty counts where it is greater.
const TOLERANCE_FRAMES: f64 = 1.0;
/// Events in the text, the worst first; JSON has all.
const SHOWN_EVENTS: usize = 10;
/// Path and text of the labels that the compiler's tests check.
const OWN_LABELS: (&str, &str) =
    ("tools/compiler/tests/gait_events/labels.csv", include_str!("../../../compiler/tests/gait_events/labels.csv"));

/// Compare the gait events of clips with labels: a file of lines `file,clip,fps,set,side,event,frame,pm`.
///
/// `frame` is the frame of the event (`strike` or `off`) and `pm` its uncertainty, in frames of the source. A label is
/// met within one frame, or within its uncertainty where that is greater.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench gait --mocap my/mocap --json")]
pub struct Args {
    #[command(flatten)]
    mocap: MocapArg,
    /// The labels; `file` is a path in the folder of clips. Those of the compiler's tests by default.
    #[arg(long, value_name = "FILE.csv")]
    labels: Option<PathBuf>,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Every label, the one with the greatest error first.
    pub events: Vec<LabelledEvent>,
    /// The labels by set.
    pub sets: Vec<LabelSet>,
}

/// One label, and the error of the nearest event.
#[derive(JsonSchema, Serialize)]
pub struct LabelledEvent {
    /// File of the clip, relative to the folder.
    pub file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub clip: String,
    /// Name of the set that the label belongs to.
    pub set: String,
    /// Foot: `left` or `right`.
    pub side: String,
    /// Event: `strike` or `off`.
    pub event: String,
    /// Frame of the event as labelled, from 0.
    pub frame: f64,
    /// Uncertainty of the label, frames.
    pub unsure_frames: f64,
    /// The compiler's event less the label, frames; null where the compiler finds no such event.
    pub error_frames: Option<f64>,
    #[serde(skip)]
    frame_rate_hz: f64,
}

/// A set of labels.
#[derive(JsonSchema, Serialize)]
pub struct LabelSet {
    /// Name of the set.
    pub name: String,
    /// Number of labels.
    pub events: usize,
    /// Share of the labels that are met, 0 to 1.
    pub within_share: f64,
    /// Share of the labels with an error of at most one frame, 0 to 1.
    pub within_one_frame_share: f64,
    /// Median size of the error, frames; null where more than half of the events are missing.
    pub median_error_frames: Option<f64>,
}

/// Runs the bench.
///
/// # Errors
/// If labels or clips cannot be read.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let mut events = match &args.labels {
        Some(path) => {
            let text = fs::read_to_string(path).map_err(|error| BenchError::unreadable(path, error))?;
            labels(path, &text)?
        }
        None => labels(Path::new(OWN_LABELS.0), OWN_LABELS.1)?,
    };
    let mut gaits = BTreeMap::new();
    for event in &mut events {
        let key = (event.file.clone(), event.clip.clone());
        if !gaits.contains_key(&key) {
            gaits.insert(key.clone(), gait(&args.mocap.mocap, event)?);
        }
        event.error_frames = gaits.get(&key).and_then(|gait| event.error_frames(gait));
    }
    events.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
    let met = share(events.iter(), |event| event.is_met());
    let name = "share of events within a source frame, or within the label's uncertainty";
    let criteria = vec![Criterion::at_least(name, 1.0, met)];
    let details = Details { sets: sets(&events), events };
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// The labels of a text; `path` is for messages.
fn labels(path: &Path, text: &str) -> Result<Vec<LabelledEvent>, BenchError> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1);
    let event = |(index, line): (usize, &str)| {
        label(line).ok_or_else(|| BenchError::Label { path: path.to_owned(), line: index + 1 })
    };
    lines.map(event).collect()
}

/// The label of one line; none where the line is malformed.
fn label(line: &str) -> Option<LabelledEvent> {
    let [file, clip, rate, set, side, event, frame, unsure] = line.split(',').collect::<Vec<_>>()[..] else {
        return None;
    };
    let [frame_rate_hz, frame, unsure_frames] = [rate.parse().ok()?, frame.parse().ok()?, unsure.parse().ok()?];
    let [file, clip, set, side, event] = [file, clip, set, side, event].map(str::to_owned);
    Some(LabelledEvent { file, clip, set, side, event, frame, unsure_frames, error_frames: None, frame_rate_hz })
}

/// The gait of the clip that a label is about.
fn gait(folder: &Path, event: &LabelledEvent) -> Result<SourceGait, BenchError> {
    let path = folder.join(&event.file);
    let clip = motiondb_compiler::import_file(&path)?.into_iter().find(|import| import.clip == event.clip);
    let unusable = |reason: String| BenchError::UnusableClip { path: path.clone(), clip: event.clip.clone(), reason };
    let human: HumanClip = match clip.map(|import| import.outcome) {
        Some(Ok(human)) => human,
        Some(Err(refusal)) => return Err(unusable(refusal.to_string())),
        None => return Err(unusable("there is no such clip; correct the label".to_owned())),
    };
    Ok(survey(vec![human]).remove(0).gait)
}

impl LabelledEvent {
    /// Distance of the nearest event of the same kind and side, frames; none where there is none.
    fn error_frames(&self, gait: &SourceGait) -> Option<f64> {
        let contacts = if self.side == "right" { &gait.right } else { &gait.left };
        let time_s = |contact: &ContactTimes| if self.event == "strike" { contact.strike_s } else { contact.toe_off_s };
        let frames = contacts.iter().filter_map(time_s).map(|time_s| f64::from(time_s) * self.frame_rate_hz);
        frames.map(|frame| frame - self.frame).min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    /// Size of the error, frames; infinite where there is no such event.
    fn distance(&self) -> f64 {
        self.error_frames.map_or(f64::INFINITY, f64::abs)
    }

    /// Whether the error is within a frame, or within the uncertainty of the label.
    fn is_met(&self) -> bool {
        self.distance() <= self.unsure_frames.max(TOLERANCE_FRAMES)
    }
}

/// The sets of labels by name.
fn sets(events: &[LabelledEvent]) -> Vec<LabelSet> {
    let mut by_name: BTreeMap<&str, Vec<&LabelledEvent>> = BTreeMap::new();
    events.iter().for_each(|event| by_name.entry(&event.set).or_default().push(event));
    let set = |(name, events): (&str, Vec<&LabelledEvent>)| {
        let share =
            |is_met: fn(&LabelledEvent) -> bool| share(events.iter(), |event| is_met(event)).unwrap_or_default();
        // All events are in order of distance.
        let median = events[events.len() / 2].distance();
        LabelSet {
            name: name.to_owned(),
            events: events.len(),
            within_share: share(LabelledEvent::is_met),
            within_one_frame_share: share(|event| event.distance() <= TOLERANCE_FRAMES),
            median_error_frames: median.is_finite().then_some(median),
        }
    };
    by_name.into_iter().map(set).collect()
}

fn text(details: &Details) -> String {
    let mut text = "farthest from their labels (frames of the source; ± uncertainty of the label)\n".to_owned();
    for event in details.events.iter().take(SHOWN_EVENTS) {
        let error = event.error_frames.map_or_else(|| "none there".to_owned(), |error| format!("{error:+.1}"));
        let LabelledEvent { file, clip, side, event, frame, unsure_frames, .. } = event;
        text += &format!("  {error}  ±{unsure_frames}  {file} {clip} {side} {event} at {frame}\n");
    }
    for set in &details.sets {
        let median = set.median_error_frames.map_or_else(|| "–".to_owned(), |median| format!("{median:.2}"));
        text += &format!(
            "{}: {} events, {:.0} % within a frame, {:.0} % within that or the label's uncertainty; median {median} frames\n",
            set.name,
            set.events,
            100.0 * set.within_one_frame_share,
            100.0 * set.within_share,
        );
    }
    text
}

//! `fbcrowd bench gait`: heel strikes and toe-offs against labels that were set by hand.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use motiondb_compiler::import_file;
use motiondb_compiler::retarget::HumanClip;
use motiondb_compiler::survey::{ContactTimes, SourceGait, survey};
use serde::Serialize;

use crate::cmd::bench::Mocap;
use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::failure::{Answer, Failure};
use crate::statistics::share;

/// Labels are met within so many frames of the source, or within what the labeller was unsure of where that is more.
const FRAMES: f64 = 1.0;
/// Events that are shown, worst first; JSON has all.
const SHOWN_EVENTS: usize = 10;
/// Labels that the compiler's tests check: where they stand, and what they say.
const OWN_LABELS: (&str, &str) =
    ("tools/compiler/tests/gait_events/labels.csv", include_str!("../../../../compiler/tests/gait_events/labels.csv"));

/// Compare the gait events of clips with labels: a file of lines `file,clip,fps,set,side,event,frame,pm`.
///
/// `frame` is where the event (`strike` or `off`) was seen and `pm` how unsure that is, in frames of the source; what
/// the labeller was unsure of is met within that. In JSON `events[] {file, clip, set, side, event, frame,
/// unsure_frames, error_frames}` and `sets[] {name, events, within_share, within_one_frame_share,
/// median_error_frames}`; an error is null where there is no such event.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench gait --mocap my/mocap --json")]
pub(super) struct Args {
    #[command(flatten)]
    mocap: Mocap,
    /// The labels, `file` being a path in the folder of clips; those of the compiler's tests by default.
    #[arg(long, value_name = "FILE.csv")]
    labels: Option<PathBuf>,
}

#[derive(Serialize)]
struct Details {
    events: Vec<Event>,
    sets: Vec<Set>,
}

/// One label, and how far the nearest event of its kind is from it.
#[derive(Serialize)]
struct Event {
    file: String,
    clip: String,
    set: String,
    side: String,
    event: String,
    frame: f64,
    unsure_frames: f64,
    error_frames: Option<f64>,
    #[serde(skip)]
    frame_rate_hz: f64,
}

/// Labels of one purpose.
#[derive(Serialize)]
struct Set {
    name: String,
    events: usize,
    /// Within a frame, or what the labeller was unsure of.
    within_share: f64,
    within_one_frame_share: f64,
    median_error_frames: Option<f64>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let mut events = match &args.labels {
        Some(path) => labels(path, &read(path)?)?,
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
    let sets = sets(&events);
    let within = share(events.iter(), |event| event.is_met());
    let name = "share of events within a source frame, or within what the labeller was unsure of";
    let bars = vec![Bar::at_least(name, 1.0, within)];
    let found = Found { details: Details { events, sets }, goals: Vec::new(), bars };
    conclude(&found, &text(&found.details), args.mocap.json)
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(|error| Failure::bad(format!("{}: {error}", path.display())))
}

fn labels(path: &Path, text: &str) -> Result<Vec<Event>, Failure> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1);
    let event = |(index, line): (usize, &str)| {
        let wrong =
            || Failure::bad(format!("{}:{}: not file,clip,fps,set,side,event,frame,pm", path.display(), index + 1));
        label(line).ok_or_else(wrong)
    };
    lines.map(event).collect()
}

fn label(line: &str) -> Option<Event> {
    let [file, clip, rate, set, side, event, frame, unsure] = line.split(',').collect::<Vec<_>>()[..] else {
        return None;
    };
    let [frame_rate_hz, frame, unsure_frames] = [rate.parse().ok()?, frame.parse().ok()?, unsure.parse().ok()?];
    let [file, clip, set, side, event] = [file, clip, set, side, event].map(str::to_owned);
    Some(Event { file, clip, set, side, event, frame, unsure_frames, error_frames: None, frame_rate_hz })
}

/// What a label's clip does.
fn gait(folder: &Path, event: &Event) -> Result<SourceGait, Failure> {
    let path = folder.join(&event.file);
    let imports = import_file(&path).map_err(|error| Failure::bad(error.to_string()))?;
    let clip = imports.into_iter().find(|import| import.clip == event.clip);
    let refused = |reason: String| Failure::bad(format!("{}, {}: {reason}", path.display(), event.clip));
    let human: HumanClip = match clip.map(|import| import.outcome) {
        Some(Ok(human)) => human,
        Some(Err(refusal)) => return Err(refused(refusal.to_string())),
        None => return Err(refused("there is no such clip".to_owned())),
    };
    Ok(survey(vec![human]).remove(0).gait)
}

impl Event {
    fn error_frames(&self, gait: &SourceGait) -> Option<f64> {
        let contacts = if self.side == "right" { &gait.right } else { &gait.left };
        let time_s = |contact: &ContactTimes| if self.event == "strike" { contact.strike_s } else { contact.toe_off_s };
        let frames = contacts.iter().filter_map(time_s).map(|time_s| f64::from(time_s) * self.frame_rate_hz);
        frames.map(|frame| frame - self.frame).min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    fn distance(&self) -> f64 {
        self.error_frames.map_or(f64::INFINITY, f64::abs)
    }

    fn is_met(&self) -> bool {
        self.distance() <= self.unsure_frames.max(FRAMES)
    }
}

fn sets(events: &[Event]) -> Vec<Set> {
    let mut by_name: BTreeMap<&str, Vec<&Event>> = BTreeMap::new();
    events.iter().for_each(|event| by_name.entry(&event.set).or_default().push(event));
    let set = |(name, events): (&str, Vec<&Event>)| {
        let share = |is_met: fn(&Event) -> bool| share(events.iter(), |event| is_met(event)).unwrap_or_default();
        // In order of distance, as all are.
        let median = events[events.len() / 2].distance();
        Set {
            name: name.to_owned(),
            events: events.len(),
            within_share: share(Event::is_met),
            within_one_frame_share: share(|event| event.distance() <= FRAMES),
            median_error_frames: median.is_finite().then_some(median),
        }
    };
    by_name.into_iter().map(set).collect()
}

fn text(details: &Details) -> String {
    let mut text = "farthest from their labels (frames of the source; ± what the labeller was unsure of)\n".to_owned();
    for event in details.events.iter().take(SHOWN_EVENTS) {
        let error = event.error_frames.map_or_else(|| "none there".to_owned(), |error| format!("{error:+.1}"));
        let Event { file, clip, side, event, frame, unsure_frames, .. } = event;
        text += &format!("  {error}  ±{unsure_frames}  {file} {clip} {side} {event} at {frame}\n");
    }
    for set in &details.sets {
        let median = set.median_error_frames.map_or_else(|| "–".to_owned(), |median| format!("{median:.2}"));
        text += &format!(
            "{}: {} events, {:.0} % within a frame, {:.0} % within that or the label's own doubt; median {median} frames\n",
            set.name,
            set.events,
            100.0 * set.within_one_frame_share,
            100.0 * set.within_share,
        );
    }
    text
}

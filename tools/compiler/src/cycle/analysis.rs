//! HumanClip → what its examples will be made of: the clip on the target skeleton, its steady windows, the mean stride
//! of each; or why it gives none.
//!
//! A folder may hold anything: dances, jumps, deaths. What steps or stands steadily may still be no model of standing
//! on the ground, and then gives no example either.

use std::ops::Range;

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Note, Unfit};
use motiondb::motion::SourceRecord;

use crate::cycle::foot_slide;
use crate::cycle::mean_stride::{self, GaitCycle};
use crate::database::parameterize;
use crate::gait::gait_events::Stance;
use crate::gait::own_body;
use crate::gait::stride::Stride;
use crate::gait::windows::{Gait, Window};
use crate::ground::arc::Rates;
use crate::ground::root_motion::{GroundedClip, leg_length_m};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::selection;

/// Lowest pelvis of a body that walks, crouched or on hands, m.
const PELVIS_HEIGHT_MIN_M: f64 = 0.01;

/// A clip on the target skeleton and those of its steady windows that may become examples.
pub(crate) struct Analyzed {
    pub grounded: GroundedClip,
    /// The longest first.
    pub windows: Vec<SteadyWindow>,
    /// Of the clip as a whole.
    pub diagnostics: Vec<Diagnostic>,
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
    /// For the clip's record, if it becomes an example.
    pub diagnostics: Vec<Diagnostic>,
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
    /// The record of the clip, with the diagnostics of import, of the clip as a whole, of its first window, of each
    /// further one with its time, and of the windows that are left out.
    pub(crate) fn record(&self, clip: &HumanClip) -> SourceRecord {
        let mut record = clip.source.clone();
        let diagnostics = &mut record.diagnostics;
        diagnostics.extend(self.diagnostics.iter().cloned());
        for (index, window) in self.windows.iter().enumerate() {
            let start_s = window.window_s[0] as f32;
            let of_window = |found: Diagnostic| if index == 0 { found } else { found.of_example_from(start_s) };
            diagnostics.extend(window.diagnostics.iter().cloned().map(of_window));
        }
        diagnostics.extend(self.left_out.note().map(Diagnostic::Note));
        record
    }
}

impl LeftOut {
    fn note(&self) -> Option<Note> {
        let [near_equal, doubtful] = [self.near_equal, self.doubtful].map(|count| count as u32);
        (near_equal + doubtful > 0).then_some(Note::WindowsLeftOut { near_equal, doubtful })
    }
}

/// Analyses one clip.
pub(crate) fn analyze(clip: &HumanClip, body: &HumanBody) -> Analyzed {
    let performer = own_body::analyze(clip);
    let grounded = performer.clip_on(clip, body);
    let found = clip.unfit.clone().map_or_else(|| performer.windows_on(&grounded, body), Err);
    let (mut windows, mut reasons) = (Vec::new(), Vec::new());
    match found {
        Ok(found) => {
            for window in found {
                match steady_window(clip, &grounded, body, &performer.gait.stances[window.reading], &window) {
                    Ok(steady) => windows.push(steady),
                    Err(unfit) => reasons.push(unfit),
                }
            }
        }
        Err(unfit) => reasons.push(unfit),
    }
    let lost_steps = performer.gait.lost_steps.filter(|_| !windows.is_empty());
    let mut left_out = selection::keep_best(&mut windows);
    let diagnostic = if windows.is_empty() {
        reasons.into_iter().next().map(Diagnostic::NoExample)
    } else {
        left_out.doubtful += reasons.len();
        lost_steps.map(|reason| Diagnostic::Note(Note::OnlyRestUsed { reason }))
    };
    Analyzed { grounded, windows, diagnostics: diagnostic.into_iter().collect(), left_out }
}

/// A window's mean stride, or why it is unfit.
fn steady_window(
    clip: &HumanClip,
    grounded: &GroundedClip,
    body: &HumanBody,
    stances: &[Vec<Stance>; 2],
    window: &Window,
) -> Result<SteadyWindow, Unfit> {
    let last_frame = (clip.frames.len() - 1) as f64;
    let second = |frame: f64| (clip.first_frame as f64 + frame.clamp(0.0, last_frame)) / clip.frame_rate_hz;
    let window_s = window.frames.map(second);
    match &window.gait {
        Gait::Stands(frames) => rest(grounded, body, frames, window_s),
        Gait::Steps(strides) => {
            let cycle = mean_stride::mean_stride(grounded, body, stances, strides);
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
) -> Result<SteadyWindow, Unfit> {
    let heights_m = grounded.poses[frames.clone()].iter().map(|pose| DVec3::Z * pose.pelvis_m.z);
    if strays(heights_m, body) {
        return Err(Unfit::PelvisOutOfReach);
    }
    let flaws = selection::flaws_of_rest(window_s[1] - window_s[0]);
    Ok(SteadyWindow {
        window_s,
        motion: Motion::Stands(frames.clone()),
        flaws,
        is_doubtful: false,
        diagnostics: Vec::new(),
    })
}

/// A window of strides, by their mean.
fn stepping(
    mut cycle: GaitCycle,
    body: &HumanBody,
    strides: &[Stride],
    window_s: [f64; 2],
) -> Result<SteadyWindow, Unfit> {
    let mut diagnostics = parameterize::snap(&mut cycle);
    if let Some(unfit) = unfit(&cycle, body) {
        return Err(unfit);
    }
    let doubts = foot_slide::lint(&cycle, body);
    let is_doubtful = !doubts.is_empty();
    diagnostics.extend(doubts);
    let flaws = selection::flaws_of_strides(strides, &cycle, body);
    Ok(SteadyWindow { window_s, motion: Motion::Steps(Box::new(cycle)), flaws, is_doubtful, diagnostics })
}

/// Why a cycle must not be blended with others, if so.
fn unfit(cycle: &GaitCycle, body: &HumanBody) -> Option<Unfit> {
    if strays(cycle.rows.iter().map(|row| row.pelvis_m), body) {
        return Some(Unfit::PelvisOutOfReach);
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

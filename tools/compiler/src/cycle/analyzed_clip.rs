//! HumanClip → AnalyzedClip: the clip on the target body and its steady cycles, or why it gives none.
//!
//! # Steps
//! 1. Find the gait on the performer's own body ([`crate::gait::performer_gait`]).
//! 2. Put the clip, and the windows of the gait, on the target body.
//! 3. Close each window into a steady cycle, or find why it is unfit ([`crate::cycle::steady_cycle`]).

use motiondb::diagnostic::{Diagnostic, Note, Unfit};
use motiondb::motion::SourceRecord;

use crate::cycle::mean_stride::mean_stride;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::gait::foot_stance::FootStance;
use crate::gait::performer_gait::PerformerGait;
use crate::gait::windows::{GaitWindow, WindowGait};
use crate::ground::root_motion::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// A clip on the target body, and its steady windows that may become examples.
pub(crate) struct AnalyzedClip {
    /// The clip on the target body.
    pub(crate) grounded: GroundedClip,
    /// Steady windows, the longest first.
    pub(crate) windows: Vec<SteadyCycle>,
    /// Diagnostics of the clip as a whole.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Steady windows that give no example beside others.
    pub(crate) left_out: LeftOutWindows,
}

/// Counts of steady windows of a clip that give no example beside others.
#[derive(Default)]
pub(crate) struct LeftOutWindows {
    /// Windows whose feet slide or are hardly planted.
    pub(crate) doubtful: usize,
    /// Windows near-equal to one that is as good or better.
    pub(crate) near_equal: usize,
}

impl AnalyzedClip {
    /// Analyses one clip.
    pub(crate) fn of(clip: &HumanClip, body: &HumanBody) -> Self {
        let mut performer = PerformerGait::of(clip);
        // Only the gait is needed from here on; the poses of an hour take a tenth of a gigabyte.
        performer.clip.poses = Vec::new();
        let grounded = performer.clip_on(clip, body);
        let found = clip.unfit.clone().map_or_else(|| performer.windows_on(&grounded, body), Err);
        let (mut windows, mut reasons) = (Vec::new(), Vec::new());
        match found {
            Ok(found) => {
                for window in found {
                    match steady_cycle(clip, &grounded, body, &performer.gait.stances[window.reading], &window) {
                        Ok(steady) => windows.push(steady),
                        Err(unfit) => reasons.push(unfit),
                    }
                }
            }
            Err(unfit) => reasons.push(unfit),
        }
        if windows.is_empty() {
            let diagnostics = reasons.into_iter().take(1).map(Diagnostic::NoExample).collect();
            return Self { grounded, windows, diagnostics, left_out: LeftOutWindows::default() };
        }
        let lost_steps = performer.gait.lost_steps.map(|reason| Diagnostic::Note(Note::OnlyRestUsed { reason }));
        let left_out = LeftOutWindows { doubtful: reasons.len(), near_equal: 0 };
        Self { grounded, windows, diagnostics: lost_steps.into_iter().collect(), left_out }
    }

    /// The record of the clip, with all diagnostics: of import, of the clip as a whole, of its first window, of each
    /// further window with its time, and of the windows that are left out.
    pub(crate) fn record(&self, clip: &HumanClip) -> SourceRecord {
        let mut record = clip.source.clone();
        let diagnostics = &mut record.diagnostics;
        diagnostics.extend(self.diagnostics.iter().cloned());
        for (index, window) in self.windows.iter().enumerate() {
            let start_s = window.window_s[0] as f32;
            let of_window = |found: Diagnostic| if index == 0 { found } else { found.with_example_start_s(start_s) };
            diagnostics.extend(window.diagnostics.iter().cloned().map(of_window));
        }
        diagnostics.extend(self.left_out.note().map(Diagnostic::Note));
        record
    }
}

impl LeftOutWindows {
    fn note(&self) -> Option<Note> {
        let [near_equal, doubtful] = [self.near_equal, self.doubtful].map(|count| count as u32);
        (near_equal + doubtful > 0).then_some(Note::WindowsLeftOut { near_equal, doubtful })
    }
}

/// The steady cycle of a window, or why it is unfit. `stances` are those of both feet, `[left, right]`.
fn steady_cycle(
    clip: &HumanClip,
    grounded: &GroundedClip,
    body: &HumanBody,
    stances: &[Vec<FootStance>; 2],
    window: &GaitWindow,
) -> Result<SteadyCycle, Unfit> {
    let last_frame = (clip.frames.len() - 1) as f64;
    let time_s = |frame: f64| (clip.first_frame as f64 + frame.clamp(0.0, last_frame)) / clip.frame_rate_hz;
    let window_s = window.frames.map(time_s);
    match &window.gait {
        WindowGait::Stands(frames) => SteadyCycle::of_rest(grounded, frames, body, window_s),
        WindowGait::Steps(strides) => {
            let cycle = mean_stride(grounded, body, stances, strides);
            SteadyCycle::of_strides(cycle, strides, body, window_s)
        }
    }
}

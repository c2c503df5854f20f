//! AnalyzedClips → SelectedCycles: a named cycle for each window, standing ones closed with the period of m_sp.
//!
//! The first window of a clip has the clip's name. A further one adds the second of the file at which it begins,
//! `capture@07.3s`, with as many digits as the clip's last second has, so that names sort by time.

use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb::motion::SourceRecord;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::standing_cycle::standing_cycle;
use crate::cycle::steady_cycle::{SteadyCycle, SteadyMotion};
use crate::error::CompileError;
use crate::input::unique_names;
use crate::retarget::human_clip::{Choices, HumanBody, HumanClip};
use crate::select::base_walk::{BaseWalkCandidate, base_walk};
use crate::select::posture_penalty::{posture_flaws, posture_penalty_mps};

/// Period of standing clips in a set without steps, s.
const STANDING_PERIOD_S: f64 = 1.0;

/// A cycle that becomes an example.
#[derive(Clone, Debug)]
pub(crate) struct NamedCycle {
    /// Name of the example.
    pub(crate) name: String,
    /// Index of the source.
    pub(crate) source: u32,
    /// First and last second of the source that the cycle is made from.
    pub(crate) window_s: [f64; 2],
    /// Left and right are exchanged.
    pub(crate) mirrored: bool,
    /// What a manifest requests for the example.
    pub(crate) choices: Choices,
    /// Flaws of the window that the cycle is made from, see [`crate::cycle::flaws`].
    pub(crate) flaws: f64,
    /// The cycle.
    pub(crate) cycle: GaitCycle,
}

impl NamedCycle {
    /// Flaws by which cycles with equal parameters are ranked: those of the window, plus the posture penalty. m_sp ranks
    /// first.
    pub(crate) fn rank(&self, body: &HumanBody) -> f64 {
        if self.choices.is_semi_procedural && !self.mirrored {
            return f64::NEG_INFINITY;
        }
        self.flaws + posture_flaws(&self.cycle, body)
    }
}

/// Index of the cycle that stands; `None` where none does.
pub(crate) fn standing(cycles: &[NamedCycle]) -> Option<usize> {
    cycles.iter().position(|named| !named.cycle.steps)
}

/// Cycles that become examples, and the records of all sources.
pub(crate) struct SelectedCycles {
    /// The cycles, each with its own name.
    pub(crate) cycles: Vec<NamedCycle>,
    /// Record of each clip, in the order of the clips.
    pub(crate) sources: Vec<SourceRecord>,
}

impl SelectedCycles {
    /// The cycles in the order of a database: by name.
    ///
    /// # Errors
    /// If there is no cycle.
    pub(crate) fn sorted(mut self) -> Result<Self, CompileError> {
        self.cycles.sort_by(|a, b| a.name.cmp(&b.name));
        if self.cycles.is_empty() {
            return Err(CompileError::NoExample { rejected: Vec::new(), sources: self.sources });
        }
        Ok(self)
    }
}

/// The cycles of all clips, one for each window, and the records of all clips.
///
/// # Errors
/// If the clip that a manifest chose as m_sp does not step.
pub(crate) fn named_cycles(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    body: &HumanBody,
) -> Result<SelectedCycles, CompileError> {
    let sources = clips.iter().zip(analyzed).map(|(clip, found)| found.record(clip)).collect();
    let base_walk = base_walk_window(clips, analyzed, body)?;
    let base_cycle = base_walk.and_then(|WindowId { clip, window }| analyzed[clip].windows[window].stepping());
    let period_s = base_cycle.map_or(STANDING_PERIOD_S, |cycle| f64::from(cycle.phase_map.period_s));
    let mut cycles = Vec::new();
    for (source, (clip, found)) in clips.iter().zip(analyzed).enumerate() {
        let AnalyzedClip { grounded, frame_count, windows, .. } = found;
        for (index, &SteadyCycle { window_s, ref motion, flaws, .. }) in windows.iter().enumerate() {
            let cycle = match motion {
                SteadyMotion::Steps(cycle) => GaitCycle::clone(cycle),
                SteadyMotion::Stands(frames) => standing_cycle(grounded, body, frames.clone(), period_s),
            };
            let name = window_name(clip, *frame_count, index, window_s);
            let is_semi_procedural = base_walk == Some(WindowId { clip: source, window: index });
            let choices = Choices { is_semi_procedural, ..clip.choices };
            cycles.push(NamedCycle { name, source: source as u32, window_s, mirrored: false, choices, flaws, cycle });
        }
    }
    unique_names::make_unique(cycles.iter_mut().map(|cycle| &mut cycle.name));
    Ok(SelectedCycles { cycles, sources })
}

/// The name of a clip's window: the first has the clip's own.
pub(crate) fn window_name(clip: &HumanClip, frame_count: usize, index: usize, window_s: [f64; 2]) -> String {
    if index == 0 {
        return clip.name.clone();
    }
    let last_s = (clip.first_frame + frame_count) as f64 / clip.frame_rate_hz;
    let width = format!("{last_s:.1}").len();
    format!("{}@{:0width$.1}s", clip.name, window_s[0])
}

/// Whether a manifest chose a window of a clip as m_sp.
pub(crate) fn is_chosen(clip: &HumanClip, index: usize, window_s: [f64; 2]) -> bool {
    let is_named = match clip.choices.semi_procedural_tenth {
        None => index == 0,
        Some(tenth) => format!("{:.1}", window_s[0]) == format!("{:.1}", f64::from(tenth) / 10.0),
    };
    clip.choices.is_semi_procedural && is_named
}

/// The window of m_sp: the one that a manifest chose, else the base walk; `None` where no window steps.
///
/// # Errors
/// If the clip that the manifest chose does not step.
fn base_walk_window(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    body: &HumanBody,
) -> Result<Option<WindowId>, CompileError> {
    let Some(clip) = clips.iter().position(|clip| clip.choices.is_semi_procedural) else {
        let (ids, candidates) = base_walk_candidates(clips, analyzed, body);
        return Ok(base_walk(&candidates).map(|index| ids[index]));
    };
    let (chosen, found) = (&clips[clip], &analyzed[clip]);
    // A base walk is deformed by its speed ahead.
    let goes_ahead = |cycle: &GaitCycle| cycle.rates.speed_mps > cycle.rates.strafe_mps.abs();
    let steps = |window: &SteadyCycle| window.stepping().is_some_and(goes_ahead);
    let named = (0..found.windows.len()).find(|&index| is_chosen(chosen, index, found.windows[index].window_s));
    named.filter(|&window| steps(&found.windows[window])).map(|window| Some(WindowId { clip, window })).ok_or_else(
        || {
            let stepping = found.windows.iter().enumerate().filter(|(_, window)| steps(window));
            let names = stepping
                .map(|(index, window)| window_name(chosen, found.frame_count, index, window.window_s))
                .collect();
            CompileError::NotStepping { name: chosen.name.clone(), stepping: names }
        },
    )
}

/// The clip and window, by index, that a cycle is made from.
#[derive(Clone, Copy, PartialEq)]
struct WindowId {
    clip: usize,
    window: usize,
}

/// The windows that step, as candidates for m_sp.
fn base_walk_candidates(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    body: &HumanBody,
) -> (Vec<WindowId>, Vec<BaseWalkCandidate>) {
    let windows = |(clip, found): (usize, &AnalyzedClip)| {
        let is_time_doubtful = clips[clip].source.diagnostics.iter().chain(&found.diagnostics).any(doubts_time);
        let candidate = |(window, steady): (usize, &SteadyCycle)| {
            let cycle = steady.stepping()?;
            let candidate = BaseWalkCandidate {
                rates: cycle.rates,
                is_upright: clips[clip].is_upright_in(steady.window_s),
                is_doubtful: steady.is_doubtful || is_time_doubtful,
                is_run: cycle.is_run(),
                posture_penalty_mps: posture_penalty_mps(cycle, body),
            };
            Some((WindowId { clip, window }, candidate))
        };
        found.windows.iter().enumerate().filter_map(candidate).collect::<Vec<_>>()
    };
    analyzed.iter().enumerate().flat_map(windows).unzip()
}

/// Whether the times of a clip, and with them its speeds, are doubtful.
fn doubts_time(found: &Diagnostic) -> bool {
    matches!(
        found,
        Diagnostic::Warning(
            Warning::FrameTimeDoubtful { .. }
                | Warning::QuickMotion { .. }
                | Warning::RareFrameRate { .. }
                | Warning::FramesDropped { .. }
                | Warning::FramesRepeated { .. }
        )
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{SyntheticWalk, performance, walk};
    use crate::{Options, compile};

    #[test]
    fn a_further_window_can_be_the_base_walk() {
        let part = |speed_mps, duration_s| {
            walk("part", SyntheticWalk { duration_s, ..SyntheticWalk::at(speed_mps, 0.0, 0.0) })
        };
        let mut capture = performance("capture", &[part(1.2, 7.0), part(0.7, 4.0)]);
        let compiled = |capture: &HumanClip| compile(vec![capture.clone()], &Options::default(), &|_| ());
        let found = compiled(&capture).unwrap();
        let [first, second] = &found.examples[..] else { panic!("{:?}", found.examples) };
        assert_eq!(found.correspondence.unwrap().semi_procedural, 0, "{first:?}");
        capture.choices.is_semi_procedural = true;
        capture.choices.semi_procedural_tenth = Some((10.0 * second.window_s[0]).round() as u32);
        let chosen = compiled(&capture).unwrap();
        assert_eq!(chosen.correspondence.unwrap().semi_procedural, 1, "{second:?}");
        capture.choices.semi_procedural_tenth = Some(999);
        let Err(CompileError::NotStepping { stepping, .. }) = compiled(&capture) else { panic!("accepted") };
        assert_eq!(stepping, [first.name.clone(), second.name.clone()]);
    }
}

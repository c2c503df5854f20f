//! Steady windows → NamedCycle: standing ones closed with the period of m_sp, each with its own name, and their
//! mirrors.
//!
//! A clip's first window has the clip's name. Further ones tell the second of the file at which they begin,
//! `capture@07.3s`, with as many digits as the clip's last second has, so that they sort by time.

use crate::cycle::analysis::{Analyzed, Motion, SteadyWindow};
use crate::cycle::mean_stride::{GaitCycle, NamedCycle};
use crate::database::correspondence;
use crate::error::CompileError;
use crate::gait::standing;
use crate::ground::arc::Rates;
use crate::input::unique_names;
use crate::retarget::human_clip::{Choices, HumanBody, HumanClip};
use crate::select::mirror;

/// Period of standing clips where none steps, seconds.
const STANDING_PERIOD_S: f64 = 1.0;

/// The cycles of all clips.
///
/// # Errors
/// Where the clip that a manifest chose as m_sp does not step.
pub(crate) fn close(
    clips: &[HumanClip],
    analyzed: Vec<Analyzed>,
    body: &HumanBody,
) -> Result<Vec<NamedCycle>, CompileError> {
    let period_s = standing_period_s(chosen_cycle(clips, &analyzed)?, &analyzed);
    let mut cycles = Vec::new();
    for (source, (clip, found)) in clips.iter().zip(analyzed).enumerate() {
        let Analyzed { grounded, windows, .. } = found;
        for (index, SteadyWindow { window_s, motion, flaws, .. }) in windows.into_iter().enumerate() {
            let cycle = match motion {
                Motion::Steps(cycle) => *cycle,
                Motion::Stands(frames) => standing::standing_cycle(&grounded, body, frames, period_s),
            };
            let name = window_name(clip, index, window_s);
            let is_semi_procedural = is_chosen(clip, index, window_s);
            let choices = Choices { is_semi_procedural, ..clip.choices };
            cycles.push(NamedCycle { name, source: source as u32, window_s, mirrored: false, choices, flaws, cycle });
        }
    }
    unique_names::make_unique(cycles.iter_mut().map(|cycle| &mut cycle.name));
    Ok(cycles)
}

/// The name of a clip's window: of the first the clip's own.
fn window_name(clip: &HumanClip, index: usize, window_s: [f64; 2]) -> String {
    if index == 0 {
        return clip.name.clone();
    }
    let last_s = (clip.first_frame + clip.frames.len()) as f64 / clip.frame_rate_hz;
    let width = format!("{last_s:.1}").len();
    format!("{}@{:0width$.1}s", clip.name, window_s[0])
}

/// Whether a manifest chose a window of a clip as m_sp.
fn is_chosen(clip: &HumanClip, index: usize, window_s: [f64; 2]) -> bool {
    let is_named = match clip.choices.semi_procedural_tenth {
        None => index == 0,
        Some(tenth) => format!("{:.1}", window_s[0]) == format!("{:.1}", f64::from(tenth) / 10.0),
    };
    clip.choices.is_semi_procedural && is_named
}

/// The cycle that a manifest chose as m_sp, if any.
fn chosen_cycle<'a>(clips: &[HumanClip], analyzed: &'a [Analyzed]) -> Result<Option<&'a GaitCycle>, CompileError> {
    let chosen = clips.iter().zip(analyzed).find(|(clip, _)| clip.choices.is_semi_procedural);
    let Some((clip, found)) = chosen else { return Ok(None) };
    let windows = || found.windows.iter().enumerate();
    let named = windows().find(|(index, window)| is_chosen(clip, *index, window.window_s));
    named.and_then(|(_, window)| window.stepping()).map(Some).ok_or_else(|| {
        let stepping = windows().filter(|(_, window)| window.stepping().is_some());
        let names = stepping.map(|(index, window)| window_name(clip, index, window.window_s)).collect();
        CompileError::NotStepping { name: clip.name.clone(), stepping: names }
    })
}

/// The period of m_sp, which standing clips take over.
fn standing_period_s(chosen: Option<&GaitCycle>, analyzed: &[Analyzed]) -> f64 {
    if let Some(cycle) = chosen {
        return f64::from(cycle.phase_map.period_s);
    }
    let windows = analyzed.iter().flat_map(|found| &found.windows);
    let stepping: Vec<&GaitCycle> = windows.filter_map(SteadyWindow::stepping).collect();
    let rates: Vec<Rates> = stepping.iter().map(|cycle| cycle.rates).collect();
    let chosen = correspondence::semi_procedural(&rates);
    chosen.map_or(STANDING_PERIOD_S, |index| f64::from(stepping[index].phase_map.period_s))
}

/// Appends the mirrors that a manifest wants, else those of one-sided cycles that have no counterpart.
pub(crate) fn add_mirrors(cycles: &mut Vec<NamedCycle>) {
    let rates: Vec<_> = cycles.iter().map(|named| named.cycle.rates).collect();
    let mirrors: Vec<NamedCycle> = cycles
        .iter()
        .filter(|named| named.choices.mirror.unwrap_or_else(|| mirror::wants_mirror(&named.cycle.rates, &rates)))
        .map(|named| NamedCycle {
            name: format!("{}_mirrored", named.name),
            mirrored: true,
            choices: Choices::default(),
            cycle: mirror::mirror(&named.cycle),
            ..*named
        })
        .collect();
    cycles.extend(mirrors);
    unique_names::make_unique(cycles.iter_mut().map(|cycle| &mut cycle.name));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Walk, performance, walk};
    use crate::{Options, compile};

    #[test]
    fn a_further_window_can_be_chosen_as_the_walk_that_is_deformed() {
        let walking = |speed_mps, duration_s| {
            let rates = Rates { speed_mps, ..Rates::default() };
            walk("part", Walk { rates, duration_s, ..Walk::default() })
        };
        let mut capture = performance("capture", &[walking(1.2, 7.0), walking(0.7, 4.0)]);
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

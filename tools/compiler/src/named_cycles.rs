//! Steady windows → NamedCycle: standing ones closed with the period of m_sp, each with its own name, and their
//! mirrors.
//!
//! A clip's first window has the clip's name. Further ones tell the second of the file at which they begin,
//! `capture@07.3s`, with as many digits as the clip's last second has, so that they sort by time.

use crate::analysis::{Analyzed, Motion, SteadyWindow};
use crate::arc::Rates;
use crate::compile_error::CompileError;
use crate::cycle::{GaitCycle, NamedCycle};
use crate::human_clip::{Choices, HumanBody, HumanClip};
use crate::{correspondence, mirror, names, standing};

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
            let name = if index == 0 { clip.name.clone() } else { window_name(clip, window_s[0]) };
            let is_semi_procedural = clip.choices.is_semi_procedural && index == 0;
            let choices = Choices { is_semi_procedural, ..clip.choices };
            cycles.push(NamedCycle { name, source: source as u32, window_s, mirrored: false, choices, flaws, cycle });
        }
    }
    names::tell_apart(cycles.iter_mut().map(|cycle| &mut cycle.name));
    Ok(cycles)
}

/// The name of a window that is not its clip's first.
fn window_name(clip: &HumanClip, start_s: f64) -> String {
    let last_s = (clip.first_frame + clip.frames.len()) as f64 / clip.frame_rate_hz;
    let width = format!("{last_s:.1}").len();
    format!("{}@{start_s:0width$.1}s", clip.name)
}

/// The cycle of the clip that a manifest chose as m_sp, if any.
fn chosen_cycle<'a>(clips: &[HumanClip], analyzed: &'a [Analyzed]) -> Result<Option<&'a GaitCycle>, CompileError> {
    let chosen = clips.iter().zip(analyzed).find(|(clip, _)| clip.choices.is_semi_procedural);
    let Some((clip, found)) = chosen else { return Ok(None) };
    let first = found.windows.first().and_then(SteadyWindow::stepping);
    first.map(Some).ok_or_else(|| CompileError::NotStepping { name: clip.name.clone() })
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
    names::tell_apart(cycles.iter_mut().map(|cycle| &mut cycle.name));
}

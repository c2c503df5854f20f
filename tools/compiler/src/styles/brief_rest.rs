//! A style in which no clip stands for long stands as in the best of the brief rests between its strides. It gives the
//! standing example, with its transitions, but no idle: so short a loop would tremble.

use std::ops::Range;

use motiondb::diagnostic::{Diagnostic, Note, Unfit};

use crate::cycle::flaws::standing_flaws;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::retarget::human_clip::HumanBody;
use crate::styles::style_part::StylePart;

/// Makes the best brief rest of a style its standing window, if no clip of the style stands.
pub(crate) fn stand_briefly(part: &mut StylePart, body: &HumanBody) {
    if part.stands() {
        return;
    }
    let candidates = (0..part.clips.len()).flat_map(|at| of_clip(part, at, body));
    let Some((at, window)) = candidates.min_by(|a, b| a.1.flaws.total_cmp(&b.1.flaws)) else { return };
    let found = &mut part.analyzed[at];
    for diagnostic in &mut found.diagnostics {
        if let Diagnostic::NoExample(reason) = diagnostic {
            *diagnostic = Diagnostic::Note(Note::OnlyRestUsed { reason: reason.clone() });
        }
    }
    let rest_s = window.window_s.map(|time_s| time_s as f32);
    found.diagnostics.push(Diagnostic::Note(Note::BriefRestUsed { rest_s }));
    found.windows.push(window);
}

/// The brief rests of a clip, each with its standing window; none of a clip whose take another one gives.
fn of_clip(part: &StylePart, at: usize, body: &HumanBody) -> Vec<(usize, SteadyCycle)> {
    let (clip, found) = (&part.clips[at], &part.analyzed[at]);
    let is_copy = |found: &Diagnostic| matches!(found, Diagnostic::NoExample(Unfit::SameTake { .. }));
    if found.diagnostics.iter().any(is_copy) {
        return Vec::new();
    }
    let candidate = |rest: &Range<usize>| {
        let window_s = found.in_file_s(clip, [rest.start as f64, (rest.end - 1) as f64]);
        let mut window = SteadyCycle::of_rest(&found.grounded, rest, body, window_s).ok()?;
        window.flaws += standing_flaws(clip);
        Some((at, window))
    };
    found.brief_rests.iter().filter_map(candidate).collect()
}

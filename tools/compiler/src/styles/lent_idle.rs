//! A style without an idle stands as the first style does: the clip of the first style that stands best is added to it,
//! without its strides and transitions. The first style, and if it does not stand each, stands as in a brief rest of its
//! own.

use motiondb::diagnostic::{Diagnostic, Note};

use crate::cycle::analyzed_clip::{AnalyzedClip, LeftOutWindows};
use crate::cycle::steady_cycle::{SteadyCycle, SteadyMotion};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::styles::brief_rest::stand_briefly;
use crate::styles::style_part::StylePart;

/// Adds the best standing clip of the first part to every part in which no clip stands.
pub(crate) fn lend_idle(parts: &mut [StylePart], body: &HumanBody) {
    let Some((lender, others)) = parts.split_first_mut() else { return };
    stand_briefly(lender, body);
    let Some(at) = lender.best_standing() else {
        others.iter_mut().for_each(|part| stand_briefly(part, body));
        return;
    };
    for part in others.iter_mut().filter(|part| !part.stands()) {
        let note = Note::IdleOfOtherStyle { style: part.style.clone(), lender: lender.style.clone() };
        let position = part.indices.partition_point(|index| *index < lender.indices[at]);
        part.indices.insert(position, lender.indices[at]);
        part.clips.insert(position, without_diagnostics(&lender.clips[at]));
        part.analyzed.insert(position, standing_parts(&lender.analyzed[at], Diagnostic::Note(note)));
    }
}

/// A clip whose diagnostics its own style reports.
fn without_diagnostics(clip: &HumanClip) -> HumanClip {
    let mut clip = clip.clone();
    clip.source.diagnostics.clear();
    clip
}

/// What a clip shows while it stands.
fn standing_parts(found: &AnalyzedClip, note: Diagnostic) -> AnalyzedClip {
    let standing = found.windows.iter().filter_map(|window| {
        Some(SteadyCycle {
            window_s: window.window_s,
            motion: SteadyMotion::Stands(window.standing()?.clone()),
            flaws: window.flaws,
            is_doubtful: window.is_doubtful,
            diagnostics: Vec::new(),
        })
    });
    AnalyzedClip {
        grounded: found.grounded.clone(),
        frame_count: found.frame_count,
        windows: standing.collect(),
        rests: found.rests.clone(),
        brief_rests: Vec::new(),
        stances: [Vec::new(), Vec::new()],
        movements: Vec::new(),
        corners: Vec::new(),
        diagnostics: vec![note],
        left_out: LeftOutWindows::default(),
    }
}

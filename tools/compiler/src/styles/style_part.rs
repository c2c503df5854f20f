//! Analysed clips → the clips of each style, in their order.
//!
//! The first style serves agents without a style: clips without a style, else the neutral ones, else the first by name;
//! of these the first that steps. Clips that can make no database of their own belong to it: clips without a style that
//! do not step, and those of a style without example.

use std::collections::BTreeMap;

use motiondb::diagnostic::{Diagnostic, Note, Warning};

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::dedup::comparison::ComparedClip;
use crate::dedup::comparison_log::ComparisonLog;
use crate::dedup::duplicates;
use crate::input::style_names::NEUTRAL_STYLES;
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// The clips of a style, analysed.
pub(crate) struct StylePart {
    /// The style; empty where it has no name.
    pub(crate) style: String,
    /// Index of each clip in the set, in ascending order.
    pub(crate) indices: Vec<usize>,
    /// The clips; they have no frames.
    pub(crate) clips: Vec<HumanClip>,
    /// Each clip in the form in which clips are compared; empty once duplicates are dropped.
    compared: Vec<ComparedClip>,
    /// The analysis of each clip.
    pub(crate) analyzed: Vec<AnalyzedClip>,
}

/// What the clips of a style show.
#[derive(Clone, Copy, Default)]
struct Shown {
    steps: bool,
    gives_example: bool,
}

/// The parts of a set, the first one for agents without a style, the others by name.
pub(crate) fn by_style(
    clips: Vec<HumanClip>,
    compared: Vec<ComparedClip>,
    mut analyzed: Vec<AnalyzedClip>,
) -> Vec<StylePart> {
    let shown = shown(&clips, &analyzed);
    let first = first_style(&shown);
    if shown.len() > 1 || !first.is_empty() {
        note_missing(&clips, &mut analyzed, &shown, &first);
    }
    let mut parts: Vec<StylePart> = vec![StylePart::empty(&first)];
    for ((index, clip), (compared, mut found)) in clips.into_iter().enumerate().zip(compared.into_iter().zip(analyzed))
    {
        let own = shown.get(&clip.style).copied().unwrap_or_default();
        let is_added = clip.style != first && (!own.gives_example || clip.style.is_empty());
        if is_added && !own.gives_example {
            (found.rests, found.brief_rests, found.movements) = Default::default();
        }
        let style = if is_added { first.clone() } else { clip.style.clone() };
        let position = parts.iter().position(|part| part.style == style).unwrap_or_else(|| {
            parts.push(StylePart::empty(&style));
            parts.len() - 1
        });
        parts[position].push(index, clip, compared, found);
    }
    parts[1..].sort_by(|a, b| a.style.cmp(&b.style));
    parts
}

fn shown(clips: &[HumanClip], analyzed: &[AnalyzedClip]) -> BTreeMap<String, Shown> {
    let mut shown: BTreeMap<String, Shown> = BTreeMap::new();
    for (clip, found) in clips.iter().zip(analyzed) {
        let of_style = shown.entry(clip.style.clone()).or_default();
        of_style.steps |= found.windows.iter().any(|window| window.stepping().is_some());
        of_style.gives_example |= !found.windows.is_empty();
    }
    shown
}

/// The style of agents that have none.
fn first_style(shown: &BTreeMap<String, Shown>) -> String {
    let rank = |style: &&String| {
        let neutral = NEUTRAL_STYLES.iter().position(|neutral| neutral == style).unwrap_or(NEUTRAL_STYLES.len());
        let Shown { steps, gives_example } = shown.get(*style).copied().unwrap_or_default();
        (!steps, !gives_example, !style.is_empty(), neutral)
    };
    shown.keys().min_by_key(rank).cloned().unwrap_or_default()
}

/// Adds a diagnostic for each style that lacks an example or a stride, to its first clip, and for clips that are added
/// to the first style.
fn note_missing(clips: &[HumanClip], analyzed: &mut [AnalyzedClip], shown: &BTreeMap<String, Shown>, first: &str) {
    for (style, Shown { steps, gives_example }) in shown {
        let named = || style.clone();
        let diagnostic = match (style.is_empty(), gives_example, steps) {
            (false, false, _) => Diagnostic::Warning(Warning::StyleWithoutExample { style: named() }),
            (false, true, false) => Diagnostic::Warning(Warning::StyleWithoutStride { style: named() }),
            (true, true, false) if !first.is_empty() => {
                Diagnostic::Note(Note::AddedToStyle { style: first.to_owned() })
            }
            _ => continue,
        };
        let gives = |index: usize| !analyzed[index].windows.is_empty();
        let all = clips.iter().enumerate().filter(|(_, clip)| clip.style == *style).map(|(index, _)| index);
        let noted: Vec<usize> =
            if style.is_empty() { all.filter(|index| gives(*index)).collect() } else { all.take(1).collect() };
        noted.into_iter().for_each(|index| analyzed[index].diagnostics.push(diagnostic.clone()));
    }
}

impl StylePart {
    fn empty(style: &str) -> Self {
        let style = style.to_owned();
        Self { style, indices: Vec::new(), clips: Vec::new(), compared: Vec::new(), analyzed: Vec::new() }
    }

    fn push(&mut self, index: usize, clip: HumanClip, compared: ComparedClip, analyzed: AnalyzedClip) {
        self.indices.push(index);
        self.clips.push(clip);
        self.compared.push(compared);
        self.analyzed.push(analyzed);
    }

    /// Drops the windows of which another clip of the style has a better copy.
    pub(crate) fn without_duplicates(mut self, body: &HumanBody, log: &ComparisonLog) -> Self {
        duplicates::drop_duplicates(&self.clips, &self.compared, &mut self.analyzed, body, log);
        self.compared = Vec::new();
        self
    }

    /// Whether a clip of the style stands.
    pub(crate) fn stands(&self) -> bool {
        self.best_standing().is_some()
    }

    /// Position of the clip that stands with the fewest flaws.
    pub(crate) fn best_standing(&self) -> Option<usize> {
        let flaws = |found: &AnalyzedClip| {
            let standing = found.windows.iter().filter(|window| window.standing().is_some());
            standing.map(|window: &SteadyCycle| window.flaws).min_by(f64::total_cmp)
        };
        let standing = self.analyzed.iter().enumerate().filter_map(|(at, found)| Some((at, flaws(found)?)));
        standing.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
    }
}

//! Clips of one take → which of their steady windows give the examples, and which are set aside for which.
//!
//! The windows of all these clips are gone through from the best on. One that gives an example is marked on every clip
//! that shows the same stretch of the take, and on those that show it by way of others. A window is set aside where
//! another clip's mark covers it, or where it is near-equal to one of a clip of its take. So what only the lesser copy
//! shows still gives an example, and where the better copy is unfit the lesser stands in.

use std::cmp::Reverse;
use std::collections::{BTreeSet, VecDeque};

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::rate_cells;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::dedup::alignment::Alignment;
use crate::dedup::frame_times::{self, Neighbours};
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Two stretches are the same where they have this share of the shorter in common.
const SAME_SHARE: f64 = 0.5;
/// Flaws ([`crate::cycle::flaws`]) that differ by less are equal, as are lengths of clips, s, and frame times' |ln|.
const SAME_FLAWS: f64 = 0.05;
const SAME_LENGTH_S: f64 = 0.1;
const SAME_SWING: f64 = 0.01;

/// A stretch of a clip that another gives the example of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    stretch_s: [f64; 2],
    /// The clip whose example it is.
    pub(crate) giver: usize,
    /// The marked clip on the giver.
    pub(crate) alignment: Alignment,
}

/// What was chosen: of each clip all marks, and of each of its windows the mark that it is set aside for.
pub(crate) struct Chosen {
    pub(crate) marks: Vec<Vec<Mark>>,
    pub(crate) aside: Vec<Vec<Option<Mark>>>,
}

/// Chooses between the windows of clips of one take. `may_pair` tells which clips can stand for each other at all.
pub(crate) fn choose(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    neighbours: &Neighbours,
    body: &HumanBody,
    may_pair: impl Fn(usize, usize) -> bool,
) -> Chosen {
    let mut marks: Vec<Vec<Mark>> = vec![Vec::new(); clips.len()];
    let mut aside: Vec<Vec<Option<Mark>>> = analyzed.iter().map(|found| vec![None; found.windows.len()]).collect();
    let mut given: Vec<Vec<Rates>> = vec![Vec::new(); clips.len()];
    for [clip, index] in by_worth(clips, analyzed, neighbours, body) {
        let window = &analyzed[clip].windows[index];
        let stretch_s = in_clip_s(&clips[clip], window);
        let covers =
            |mark: &&Mark| mark.giver != clip && may_pair(mark.giver, clip) && are_same(mark.stretch_s, stretch_s);
        let near_equal = || {
            let is_near = |(other, on_other): &&(usize, Alignment)| {
                given[*other].iter().any(|rates| rate_cells::are_near_equal(rates, &seen_on(on_other, &window.rates())))
            };
            let (giver, alignment) = neighbours[clip].iter().find(is_near)?;
            Some(Mark { stretch_s, giver: *giver, alignment: *alignment })
        };
        aside[clip][index] = marks[clip].iter().find(covers).copied().or_else(near_equal);
        if aside[clip][index].is_none() {
            given[clip].push(window.rates());
            mark(&mut marks, clips, neighbours, clip, stretch_s);
        }
    }
    Chosen { marks, aside }
}

/// Clip and index of every window that has rivals, from the best on: one that a manifest chose; one whose frame time is
/// a human's; one whose root travels; one beyond doubt; one with fewer flaws, wherever in its cell; one of a longer
/// clip, then of more frames a second; the first.
fn by_worth(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    neighbours: &Neighbours,
    body: &HumanBody,
) -> Vec<[usize; 2]> {
    let implausible = frame_times::implausibilities(clips, analyzed, neighbours, body);
    let in_steps = |value: f64, step: f64| libm::round(value / step) as i64;
    let worth = |&[index, window]: &[usize; 2]| {
        let (clip, window) = (&clips[index], &analyzed[index].windows[window]);
        let flaws = window.flaws - rate_cells::distance_from_middle(&window.rates());
        (
            Reverse((clip.choices.is_semi_procedural, clip.choices.is_target_skeleton)),
            in_steps(implausible[index], SAME_SWING),
            clip.in_place_mps.is_some(),
            window.is_doubtful,
            in_steps(flaws, SAME_FLAWS),
            Reverse(in_steps(duration_s(clip), SAME_LENGTH_S)),
            Reverse(clip.frame_rate_hz.to_bits()),
        )
    };
    let rivals = (0..clips.len()).filter(|&clip| !neighbours[clip].is_empty());
    let mut order: Vec<[usize; 2]> =
        rivals.flat_map(|clip| (0..analyzed[clip].windows.len()).map(move |window| [clip, window])).collect();
    order.sort_by_cached_key(worth);
    order
}

/// Marks a stretch on its own clip and, from clip to clip, on all that show it.
fn mark(marks: &mut [Vec<Mark>], clips: &[HumanClip], neighbours: &Neighbours, giver: usize, stretch_s: [f64; 2]) {
    let mut is_marked = BTreeSet::from([giver]);
    let mut reached = VecDeque::from([(giver, Mark { stretch_s, giver, alignment: Alignment::SAME })]);
    while let Some((clip, mark)) = reached.pop_front() {
        marks[clip].push(mark);
        for (other, on_other) in &neighbours[clip] {
            let there_s = on_other.at(mark.stretch_s);
            let whole_s = [0.0, duration_s(&clips[*other])];
            if are_same(there_s, whole_s) && is_marked.insert(*other) {
                let stretch_s = [there_s[0].max(whole_s[0]), there_s[1].min(whole_s[1])];
                reached.push_back((
                    *other,
                    Mark { stretch_s, giver, alignment: on_other.inverse().then(&mark.alignment) },
                ));
            }
        }
    }
}

fn are_same(a: [f64; 2], b: [f64; 2]) -> bool {
    let common_s = a[1].min(b[1]) - a[0].max(b[0]);
    common_s >= SAME_SHARE * (a[1] - a[0]).min(b[1] - b[0])
}

/// Rates of a clip as the other that it lies on shows them.
fn seen_on(alignment: &Alignment, rates: &Rates) -> Rates {
    let side = if alignment.mirrored { -1.0 } else { 1.0 };
    Rates {
        speed_mps: rates.speed_mps / alignment.pace,
        turn_rate_rad_s: side * rates.turn_rate_rad_s / alignment.pace,
        strafe_mps: side * rates.strafe_mps / alignment.pace,
    }
}

/// A window in seconds from its clip's beginning, which may lie within the file.
fn in_clip_s(clip: &HumanClip, window: &SteadyCycle) -> [f64; 2] {
    window.window_s.map(|time_s| time_s - clip.first_frame as f64 / clip.frame_rate_hz)
}

fn duration_s(clip: &HumanClip) -> f64 {
    (clip.frames.len() - 1) as f64 / clip.frame_rate_hz
}

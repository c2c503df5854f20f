//! Groups of clips of one take → which of their steady windows give the examples, and which are set aside for which.
//!
//! The windows of a group are gone through from the best on. One is set aside where it shows the same stretch of the
//! take as a window of another clip that gives an example, or where it is near-equal to one. So what only the lesser
//! copy shows still gives an example, and where the better copy is unfit the lesser stands in. Times and rates of all
//! clips of a group are compared as its leader shows them.

use std::cmp::Reverse;

use crate::dedup::alignment::Alignment;
use crate::dedup::frame_times;
use crate::dedup::groups::Groups;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::cycle::rate_cells;

/// Two stretches are the same where they have this share of the shorter in common.
const SAME_SHARE: f64 = 0.5;
/// Flaws ([`crate::cycle::flaws`]) that differ by less are equal, as are lengths of clips, s, and frame times' |ln|.
const SAME_FLAWS: f64 = 0.05;
const SAME_LENGTH_S: f64 = 0.1;
const SAME_SWING: f64 = 0.01;

/// A clip whose example stands in for another clip's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Giver {
    pub(crate) clip: usize,
    /// The other clip on it.
    pub(crate) alignment: Alignment,
}

/// What was chosen.
pub(crate) struct Chosen {
    /// Of each window of each clip the clip that it is set aside for.
    pub(crate) aside: Vec<Vec<Option<Giver>>>,
    /// Of each clip the one that gives the best example of what it shows; it may be itself.
    pub(crate) best: Vec<Option<Giver>>,
}

/// A window that gives an example, as the leader of a group shows it.
struct Given {
    clip: usize,
    on_leader: Alignment,
    stretch_s: [f64; 2],
    rates: Rates,
}

impl Given {
    /// As the one that stands in for a clip.
    fn for_clip(&self, on_leader: &Alignment) -> Giver {
        Giver { clip: self.clip, alignment: on_leader.then(&self.on_leader.inverse()) }
    }
}

/// Chooses between the windows of clips of one take. `may_pair` states which clips can stand for each other at all.
pub(crate) fn choose(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    groups: &Groups,
    body: &HumanBody,
    may_pair: impl Fn(usize, usize) -> bool,
) -> Chosen {
    let of_clips = groups.of_clips(clips.len());
    let mut aside: Vec<Vec<Option<Giver>>> = analyzed.iter().map(|found| vec![None; found.windows.len()]).collect();
    let mut given: Vec<Vec<Given>> = groups.members.iter().map(|_| Vec::new()).collect();
    for [clip, index] in by_worth(clips, analyzed, groups, &of_clips, body) {
        let window = &analyzed[clip].windows[index];
        let here = |on_leader: &Alignment| Given {
            clip,
            on_leader: *on_leader,
            stretch_s: on_leader.at(in_clip_s(&clips[clip], window)),
            rates: on_leader.rates(&window.rates()),
        };
        let stands_in = |given: &&Given, here: &Given| {
            let is_same = are_same(given.stretch_s, here.stretch_s);
            given.clip != clip
                && may_pair(given.clip, clip)
                && (is_same || rate_cells::are_near_equal(&given.rates, &here.rates))
        };
        aside[clip][index] = of_clips[clip].iter().find_map(|(group, on_leader)| {
            let here = here(on_leader);
            given[*group].iter().find(|given| stands_in(given, &here)).map(|given| given.for_clip(on_leader))
        });
        if aside[clip][index].is_none() {
            of_clips[clip].iter().for_each(|(group, on_leader)| given[*group].push(here(on_leader)));
        }
    }
    let best = |clip: usize| {
        let whole_s = [0.0, duration_s(&clips[clip])];
        of_clips[clip].iter().find_map(|(group, on_leader)| {
            let mut shown = given[*group].iter().filter(|given| are_same(given.stretch_s, on_leader.at(whole_s)));
            shown.next().map(|given| given.for_clip(on_leader))
        })
    };
    Chosen { aside, best: (0..clips.len()).map(best).collect() }
}

/// Clip and index of every window that has rivals, from the best on: one that a manifest chose; one whose frame time is
/// a human's; one whose root travels; one beyond doubt; one with fewer flaws, wherever in its cell; one of a longer
/// clip, then of more frames a second; the first.
fn by_worth(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    groups: &Groups,
    of_clips: &[Vec<(usize, Alignment)>],
    body: &HumanBody,
) -> Vec<[usize; 2]> {
    let implausible = frame_times::implausibilities(clips, analyzed, groups, body);
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
    let rivals = (0..clips.len()).filter(|&clip| !of_clips[clip].is_empty());
    let mut order: Vec<[usize; 2]> =
        rivals.flat_map(|clip| (0..analyzed[clip].windows.len()).map(move |window| [clip, window])).collect();
    order.sort_by_cached_key(worth);
    order
}

fn are_same(a: [f64; 2], b: [f64; 2]) -> bool {
    let common_s = a[1].min(b[1]) - a[0].max(b[0]);
    common_s >= SAME_SHARE * (a[1] - a[0]).min(b[1] - b[0])
}

/// A window in seconds from its clip's beginning, which may lie within the file.
fn in_clip_s(clip: &HumanClip, window: &SteadyCycle) -> [f64; 2] {
    window.window_s.map(|time_s| time_s - clip.first_frame as f64 / clip.frame_rate_hz)
}

/// From the first frame to the last.
pub(crate) fn duration_s(clip: &HumanClip) -> f64 {
    (clip.frames.len() - 1) as f64 / clip.frame_rate_hz
}

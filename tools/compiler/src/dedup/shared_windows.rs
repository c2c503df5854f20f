//! Choice between the steady windows of clips of one take: which give examples, and which other clips replace the rest.
//!
//! The windows of all groups are taken from the best on. A window is replaced where a window of another clip that gives
//! an example shows the same part of the take, or is near-equal. So a part that only the worse copy shows still gives
//! an example. Times and rates are compared in the time of the group's leader.

use std::cmp::Reverse;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::rate_cells;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::dedup::alignment::Alignment;
use crate::dedup::frame_times;
use crate::dedup::groups::Groups;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Common share of the shorter of two windows from which on both show the same part of a take.
const SAME_SHARE: f64 = 0.5;
/// Step in which flaws are compared ([`crate::cycle::flaws`]).
const FLAWS_STEP: f64 = 0.05;
/// Step in which durations of clips are compared, s.
const DURATION_STEP_S: f64 = 0.1;
/// Step in which implausibilities of frame times are compared, |ln|.
const IMPLAUSIBILITY_STEP: f64 = 0.01;

/// A clip whose example replaces that of another clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Giver {
    /// Index of the clip that gives the example.
    pub(crate) clip: usize,
    /// The other clip on the giver.
    pub(crate) alignment: Alignment,
}

/// The clips that give examples in place of others.
pub(crate) struct Givers {
    /// For each window of each clip: the clip that replaces it; `None` where it gives an example itself.
    pub(crate) of_windows: Vec<Vec<Option<Giver>>>,
    /// For each clip: the clip that gives the best example of its take; it may be itself.
    pub(crate) of_clips: Vec<Option<Giver>>,
}

/// A window in the time of a group's leader.
struct AlignedWindow {
    clip: usize,
    on_leader: Alignment,
    window_s: [f64; 2],
    rates: Rates,
}

impl AlignedWindow {
    /// This window's clip as the giver for another clip of the group.
    fn giver(&self, on_leader: &Alignment) -> Giver {
        Giver { clip: self.clip, alignment: on_leader.then(&self.on_leader.inverse()) }
    }

    /// Whether this window replaces another one.
    fn replaces(&self, other: &Self) -> bool {
        self.clip != other.clip
            && (are_same(self.window_s, other.window_s) || rate_cells::are_near_equal(&self.rates, &other.rates))
    }
}

/// Chooses between the windows of clips of one take. `may_pair` states which clips may replace each other.
pub(crate) fn choose(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    groups: &Groups,
    body: &HumanBody,
    may_pair: impl Fn(usize, usize) -> bool,
) -> Givers {
    let groups_of = groups.of_clips(clips.len());
    let mut of_windows: Vec<Vec<Option<Giver>>> =
        analyzed.iter().map(|found| vec![None; found.windows.len()]).collect();
    let mut giving: Vec<Vec<AlignedWindow>> = groups.members.iter().map(|_| Vec::new()).collect();
    for [clip, index] in best_first(clips, analyzed, groups, &groups_of, body) {
        let window = &analyzed[clip].windows[index];
        let aligned = |on_leader: &Alignment| AlignedWindow {
            clip,
            on_leader: *on_leader,
            window_s: on_leader.at(in_clip_s(&clips[clip], window)),
            rates: on_leader.rates(&window.rates()),
        };
        let giver = groups_of[clip].iter().find_map(|(group, on_leader)| {
            let own = aligned(on_leader);
            let replaces = |given: &&AlignedWindow| may_pair(given.clip, clip) && given.replaces(&own);
            giving[*group].iter().find(replaces).map(|given| given.giver(on_leader))
        });
        of_windows[clip][index] = giver;
        if giver.is_none() {
            groups_of[clip].iter().for_each(|(group, on_leader)| giving[*group].push(aligned(on_leader)));
        }
    }
    let of_clip = |clip: usize| {
        let whole_s = [0.0, analyzed[clip].duration_s()];
        groups_of[clip].iter().find_map(|(group, on_leader)| {
            let shows = |given: &&AlignedWindow| are_same(given.window_s, on_leader.at(whole_s));
            giving[*group].iter().find(shows).map(|given| given.giver(on_leader))
        })
    };
    Givers { of_windows, of_clips: (0..clips.len()).map(of_clip).collect() }
}

/// Clip and index of every window of a clip that has copies, the best first: chosen in a manifest, human frame time,
/// root travels, beyond doubt, few flaws (apart from the position in its cell), long clip, many frames a second.
fn best_first(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    groups: &Groups,
    groups_of: &[Vec<(usize, Alignment)>],
    body: &HumanBody,
) -> Vec<[usize; 2]> {
    let implausible = frame_times::implausibilities(clips, analyzed, groups, body);
    let in_steps = |value: f64, step: f64| libm::round(value / step) as i64;
    let rank = |&[index, window]: &[usize; 2]| {
        let (clip, window) = (&clips[index], &analyzed[index].windows[window]);
        let flaws = window.flaws - rate_cells::distance_from_middle(&window.rates());
        (
            Reverse((clip.choices.is_semi_procedural, clip.choices.is_target_skeleton)),
            in_steps(implausible[index], IMPLAUSIBILITY_STEP),
            clip.in_place_mps.is_some(),
            window.is_doubtful,
            in_steps(flaws, FLAWS_STEP),
            Reverse(in_steps(analyzed[index].duration_s(), DURATION_STEP_S)),
            Reverse(clip.frame_rate_hz.to_bits()),
        )
    };
    let with_copies = (0..clips.len()).filter(|&clip| !groups_of[clip].is_empty());
    let mut order: Vec<[usize; 2]> =
        with_copies.flat_map(|clip| (0..analyzed[clip].windows.len()).map(move |window| [clip, window])).collect();
    order.sort_by_cached_key(rank);
    order
}

/// Whether two intervals, s, are the same part of a take.
fn are_same(a: [f64; 2], b: [f64; 2]) -> bool {
    let common_s = a[1].min(b[1]) - a[0].max(b[0]);
    common_s >= SAME_SHARE * (a[1] - a[0]).min(b[1] - b[0])
}

/// First and last time of a window, s from its clip's beginning, which may lie within the file.
fn in_clip_s(clip: &HumanClip, window: &SteadyCycle) -> [f64; 2] {
    window.window_s.map(|time_s| time_s - clip.first_frame as f64 / clip.frame_rate_hz)
}

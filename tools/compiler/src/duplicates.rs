//! The same take twice: under another name, at another frame rate, with a lying frame time, on another skeleton, as a
//! part of the other or mirrored. One of the two gives examples.
//!
//! `take_search` chooses which clips are compared, `same_take` decides of two clips.

use std::cmp::Reverse;

use rayon::prelude::*;

use crate::analysis::Analyzed;
use crate::human_clip::HumanClip;
use crate::performance::Performance;
use crate::remark::{ANOTHER_FRAME_TIME, NO_EXAMPLE};
use crate::same_take::Entry;
use crate::take_search::{self, Found, LIST_MAX, Search};

/// Clips of its take that a clip's record names; the others are counted.
const NAMED_MAX: usize = 8;
/// Clips whose lengths differ by less are equally long, s.
const SAME_LENGTH_S: f64 = 0.1;

/// Two clips of one take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Indices of the clips, ascending.
    pub clips: [usize; 2],
    /// One is the other's mirror image.
    pub mirrored: bool,
    /// Their frames agree, their frame times do not.
    pub times_differ: bool,
    /// r of `performance`.
    pub unlikeness: f64,
}

/// What becomes of a clip.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Another clip of the take gives the examples.
    pub is_surplus: bool,
    /// What its record says.
    pub remarks: Vec<String>,
}

/// Takes their examples from clips of whose takes others give them, and says of every clip which others show its take.
pub(crate) fn set_aside(clips: &[HumanClip], analyzed: &mut [Analyzed]) {
    let gives_example: Vec<bool> = analyzed.iter().map(|found| !found.windows.is_empty()).collect();
    for (found, verdict) in analyzed.iter_mut().zip(verdicts(clips, &gives_example)) {
        if verdict.is_surplus {
            found.windows.clear();
        }
        found.warnings.extend(verdict.remarks);
    }
}

/// A verdict for each clip. Of one take the best clip that gives an example does: one that a manifest gives a part to,
/// one whose frame time is plausible, the longer, the one with more frames a second, the first by name.
pub fn verdicts(clips: &[HumanClip], gives_example: &[bool]) -> Vec<Verdict> {
    let order = by_worth(clips, gives_example);
    let search = searched(clips, &order);
    let pairs = in_order(&search.found);
    let mut others = vec![Vec::new(); clips.len()];
    for pair in &pairs {
        others[pair.clips[0]].push((pair.clips[1], pair));
        others[pair.clips[1]].push((pair.clips[0], pair));
    }
    let mut verdicts = vec![Verdict::default(); clips.len()];
    let mut is_better = vec![false; clips.len()];
    for &clip in &order {
        let shows_it =
            |&(other, _): &(usize, &Pair)| is_better[other] && gives_example[other] && !verdicts[other].is_surplus;
        verdicts[clip].is_surplus = others[clip].iter().any(shows_it);
        is_better[clip] = true;
    }
    let surplus: Vec<bool> = verdicts.iter().map(|verdict| verdict.is_surplus).collect();
    for (clip, others) in others.iter().enumerate() {
        verdicts[clip].remarks = remarks(clips, &surplus, clip, others);
    }
    for clip in search.beyond_list {
        let remark = format!("too many clips: whether it is the same take is known of the {LIST_MAX} best only");
        verdicts[clip].remarks.push(remark);
    }
    verdicts
}

/// The clips from the best on.
fn by_worth(clips: &[HumanClip], gives_example: &[bool]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..clips.len()).collect();
    order.sort_by_cached_key(|&clip| (!gives_example[clip], worth(&clips[clip]), clip));
    order
}

/// What is said of a clip's take.
fn remarks(clips: &[HumanClip], surplus: &[bool], clip: usize, others: &[(usize, &Pair)]) -> Vec<String> {
    // Those that give the example come first: they are the reason.
    let (shown, rest): (Vec<_>, Vec<_>) =
        others.iter().copied().partition(|(other, _)| surplus[clip] && !surplus[*other]);
    let named = shown.into_iter().chain(rest).take(NAMED_MAX);
    let said = named.map(|(other, pair)| remark(pair, &clips[other], surplus[clip], surplus[other]));
    let more = others.len().saturating_sub(NAMED_MAX);
    said.chain((more > 0).then(|| format!("the same take as {more} more clips"))).collect()
}

fn remark(pair: &Pair, other: &HumanClip, is_surplus: bool, other_is_surplus: bool) -> String {
    let mirrored = if pair.mirrored { ", mirrored" } else { "" };
    let timed = if pair.times_differ { format!(", {ANOTHER_FRAME_TIME}") } else { String::new() };
    let same = format!("the same take as {}{mirrored}{timed}", title(other));
    match (is_surplus, other_is_surplus) {
        (true, false) => format!("{NO_EXAMPLE}{same}"),
        (false, true) => format!("{same}; no example is made of that one"),
        _ => same,
    }
}

fn title(clip: &HumanClip) -> String {
    format!("{} {}", clip.source.file, clip.source.clip).trim_end().to_owned()
}

/// Ascending from the best; equals go in the clips' order.
fn worth(clip: &HumanClip) -> impl Ord {
    let is_in_place = clip.in_place_mps.is_some();
    let length = libm::round(clip.frames.len() as f64 / clip.frame_rate_hz / SAME_LENGTH_S) as u64;
    let chosen = Reverse((clip.choices.is_semi_procedural, clip.choices.is_target_skeleton));
    (
        chosen,
        clip.is_impossible(),
        is_in_place,
        Reverse(length),
        Reverse(clip.frame_rate_hz.to_bits()),
        clip.name.clone(),
    )
}

/// Every two clips of one take, in the clips' order; of a take of very many clips not every two (`take_search`).
pub fn pairs(clips: &[HumanClip]) -> Vec<Pair> {
    in_order(&searched(clips, &by_worth(clips, &vec![true; clips.len()])).found)
}

fn searched(clips: &[HumanClip], order: &[usize]) -> Search {
    let entries: Vec<Entry> = clips.par_iter().map(|clip| Entry::new(Performance::of(clip))).collect();
    take_search::search(&entries, order, |a, b| !are_parts_of_one_file(&clips[a], &clips[b]))
}

fn in_order(found: &[Found]) -> Vec<Pair> {
    let pair = |&(better, worse, how): &Found| Pair {
        clips: [better.min(worse), better.max(worse)],
        mirrored: how.mirrored,
        times_differ: how.times_differ,
        unlikeness: how.unlikeness,
    };
    let mut pairs: Vec<Pair> = found.iter().map(pair).collect();
    pairs.sort_by_key(|pair| pair.clips);
    pairs
}

/// Whoever cuts a capture in a manifest wants both parts.
fn are_parts_of_one_file(a: &HumanClip, b: &HumanClip) -> bool {
    (a.choices.is_cut || b.choices.is_cut) && a.source.file == b.source.file && a.source.clip == b.source.clip
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arc::Rates;
    use crate::human_clip::HumanPose;
    use crate::mirror::mirror_pose;
    use crate::synthetic::{Walk, idle, walk};

    fn bend() -> Walk {
        Walk {
            rates: Rates { speed_mps: 0.9, turn_rate_rad_s: 0.5, strafe_mps: 0.0 },
            left_share: 0.53,
            ..Walk::default()
        }
    }

    /// The only pair of two clips.
    #[track_caller]
    fn check_one_take(one: HumanClip, other: HumanClip, mirrored: bool, times_differ: bool) {
        let found = pairs(&[one, other]);
        assert_eq!(found.len(), 1);
        let Pair { mirrored: is_mirrored, times_differ: differ, unlikeness, .. } = found[0];
        assert_eq!((is_mirrored, differ), (mirrored, times_differ), "{found:?}");
        assert!(unlikeness < 0.1, "{found:?}");
    }

    fn mirrored(mut clip: HumanClip) -> HumanClip {
        clip.frames.iter_mut().for_each(|pose: &mut HumanPose| *pose = mirror_pose(pose));
        clip
    }

    #[test]
    fn a_take_is_known_at_another_rate_on_another_body_in_part_and_mirrored() {
        let told = || walk("told", bend());
        check_one_take(told(), walk("copy", bend()), false, false);
        check_one_take(told(), walk("finer", Walk { frame_rate_hz: 100.0, ..bend() }), false, false);
        let giant = Rates { speed_mps: 1.7 * 0.9, ..bend().rates };
        check_one_take(told(), walk("giant", Walk { size: 1.7, rates: giant, ..bend() }), false, false);
        let mut part = told();
        part.frames = part.frames[70..200].to_vec();
        check_one_take(told(), part.clone(), false, false);
        check_one_take(mirrored(part), told(), true, false);
    }

    #[test]
    fn a_lying_frame_time_hides_no_take() {
        let mut slow = walk("slow", bend());
        slow.frame_rate_hz = 25.0;
        check_one_take(slow.clone(), walk("told", bend()), false, true);
        let every_second = walk("coarse", Walk { frame_rate_hz: 30.0, ..bend() });
        check_one_take(every_second, slow, false, true);
    }

    #[test]
    fn other_walks_and_bodies_that_stand_are_other_takes() {
        let straight = Rates { turn_rate_rad_s: 0.0, ..bend().rates };
        let clips = [
            walk("bend", bend()),
            walk("straight", Walk { rates: straight, ..bend() }),
            walk("quick", Walk { period_s: 0.95, ..bend() }),
            walk("slow", Walk { period_s: 1.3, ..bend() }),
            idle("idle", 3.0),
        ];
        assert_eq!(pairs(&clips), []);
    }

    #[test]
    fn the_chosen_the_true_the_longer_and_the_finer_take_gives_the_examples() {
        let told = || walk("told", bend());
        let check = |better: HumanClip, gives: bool, names: [&str; 2]| {
            let mut clips = [told(), better];
            clips[1].name = names[1].into();
            clips[0].name = names[0].into();
            let verdicts = verdicts(&clips, &[true, gives]);
            let surplus: Vec<bool> = verdicts.iter().map(|verdict| verdict.is_surplus).collect();
            assert_eq!(surplus, if gives { [true, false] } else { [false, true] }, "{verdicts:?}");
            let [first, second] = [0, 1].map(|clip| verdicts[clip].remarks.join("; "));
            assert!(first.contains("the same take as") && second.contains("the same take as"), "{first}, {second}");
        };
        check(walk("longer", Walk { duration_s: 4.3, ..bend() }), true, ["a", "b"]);
        check(walk("finer", Walk { frame_rate_hz: 120.0, ..bend() }), true, ["a", "b"]);
        check(told(), true, ["b", "a"]);
        let mut chosen = walk("chosen", Walk { duration_s: 3.7, ..bend() });
        chosen.choices.is_target_skeleton = true;
        check(chosen, true, ["a", "b"]);
    }

    #[test]
    fn of_hundreds_of_copies_one_gives_the_example_and_the_records_stay_short() {
        let copy = |index: usize| {
            let mut clip = walk(&format!("{index:03}"), bend());
            clip.frames.drain(..index % 23);
            if index % 3 == 1 { mirrored(clip) } else { clip }
        };
        let clips: Vec<HumanClip> = (0..300).map(copy).collect();
        let verdicts = verdicts(&clips, &[true; 300]);
        assert_eq!(verdicts.iter().filter(|verdict| !verdict.is_surplus).count(), 1);
        assert!(verdicts.iter().all(|verdict| (1..=NAMED_MAX + 1).contains(&verdict.remarks.len())), "{verdicts:?}");
    }

    #[test]
    fn parts_that_a_manifest_cuts_out_of_one_file_stay_two_clips() {
        let part = |name: &str| {
            let mut clip = walk(name, bend());
            clip.source.file = "capture.bvh".into();
            clip.choices.is_cut = true;
            clip
        };
        assert_eq!(pairs(&[part("one"), part("other")]), []);
    }
}

//! The same take twice: under another name, at another frame rate, with a lying frame time, on another skeleton, as a
//! part of the other or mirrored. One of the two gives examples.
//!
//! Every pair of clips is screened by the legs' directions ([`crate::performance`]) at all lags that leave most of the
//! shorter clip covered; what comes near is compared exactly, in steps of 1/120 s. Two clips are one take where limbs,
//! trunk and head move alike *and* the facing turns and swings alike: the first alone cannot tell made-up walks, the
//! second alone no regular walkers.
//!
//! Measured over all pairs of 151 clips of 14 sources: retargeted copies have r up to 0.19 (a run of 1.4 s, CMU 02_03, on
//! two skeletons), all others up to 0.07. Of different takes the nearest are two made-up straight walks (0.26, but their
//! facings swing in antiphase), a left and a right turn of one performer (0.28) and walks of one performer (0.29 and
//! more). The limit lies in the middle of the gap.

use std::cmp::Reverse;
use std::f64::consts::PI;

use rayon::prelude::*;

use crate::analysis::Analyzed;
use crate::human_clip::HumanClip;
use crate::outline::{Outline, SCREEN_MAX, nearest_lag};
use crate::performance::{self, Likeness, Performance};
use crate::remark::{FRAME_TIME_QUESTION, NO_EXAMPLE};

/// Rate at which pairs are screened, Hz, and exact lags in one of its steps.
const SCREEN_HZ: f64 = 20.0;
const EXACT_STEPS: isize = 6;
/// Greatest r of one take.
const UNLIKENESS_MAX: f64 = 0.23;
/// Shorter overlaps must be the more alike, in proportion, s: about a stride tells little of a performer.
const SURE_S: f64 = 1.2;
/// Clips that stir less have no course to compare: 0.2°.
const MOVEMENT_MIN_RAD: f64 = 0.2 * PI / 180.0;
/// Facings of one take: retargeting changes the size of their swing, hardly its course (0.97 and more); at the lags of
/// the screening less.
const FACING_CORRELATION_MIN: f64 = 0.9;
const SCREEN_CORRELATION_MIN: f64 = 0.75;
/// And turn alike within what the whole clip's turn rate is judged by (`definitions.md`): 3 °/s or 15° over the clip.
const TURN_DIFFERENCE_RAD_S: f64 = 3.0 * PI / 180.0;
const TURN_DIFFERENCE_RAD: f64 = 15.0 * PI / 180.0;
/// Frames of one clip per frame of the other that are tried where the frame counts fit and the times do not.
const FRAME_RATIOS: [f64; 3] = [0.5, 1.0, 2.0];
/// How far counts may be off (trimmed ends), and how far times must be, as a share.
const COUNT_TOLERANCE: f64 = 0.1;
const TIME_TOLERANCE: f64 = 0.05;
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
    /// r of [`crate::performance`].
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
    let pairs = pairs(clips);
    let mut verdicts = vec![Verdict::default(); clips.len()];
    let mut by_worth: Vec<usize> = (0..clips.len()).collect();
    by_worth.sort_by(|&a, &b| worth(&clips[a]).cmp(&worth(&clips[b])).then(a.cmp(&b)));
    for (rank, &clip) in by_worth.iter().enumerate() {
        let better = |other: usize| by_worth[..rank].contains(&other);
        for pair in pairs.iter().filter(|pair| pair.clips.contains(&clip)) {
            let other = if pair.clips[0] == clip { pair.clips[1] } else { pair.clips[0] };
            if better(other) && gives_example[other] && !verdicts[other].is_surplus {
                verdicts[clip].is_surplus = true;
            }
        }
    }
    for pair in &pairs {
        for (clip, other) in [(pair.clips[0], pair.clips[1]), (pair.clips[1], pair.clips[0])] {
            let remark = remark(pair, &clips[other], verdicts[clip].is_surplus, verdicts[other].is_surplus);
            verdicts[clip].remarks.push(remark);
        }
    }
    verdicts
}

fn remark(pair: &Pair, other: &HumanClip, is_surplus: bool, other_is_surplus: bool) -> String {
    let mirrored = if pair.mirrored { ", mirrored" } else { "" };
    let timed = if pair.times_differ { ", at another frame time" } else { "" };
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
    let lies = clip.source.warnings.iter().any(|warning| warning.ends_with(FRAME_TIME_QUESTION));
    let length = libm::round(clip.frames.len() as f64 / clip.frame_rate_hz / SAME_LENGTH_S) as u64;
    let chosen = Reverse((clip.choices.is_semi_procedural, clip.choices.is_target_skeleton));
    (chosen, lies, Reverse(length), Reverse(clip.frame_rate_hz.to_bits()), clip.name.clone())
}

/// Every two clips of one take, in the clips' order.
pub fn pairs(clips: &[HumanClip]) -> Vec<Pair> {
    let entries: Vec<Entry> = clips.par_iter().map(|clip| Entry::new(Performance::of(clip))).collect();
    let with_later = |first: usize| {
        let later = first + 1..entries.len();
        let apart = |second: &usize| !are_parts_of_one_file(&clips[first], &clips[*second]);
        let pair = |second: usize| pair(&entries, [first, second]);
        later.filter(apart).filter_map(pair).collect::<Vec<Pair>>()
    };
    (0..entries.len()).into_par_iter().flat_map_iter(with_later).collect()
}

/// Whoever cuts a capture in a manifest wants both parts.
fn are_parts_of_one_file(a: &HumanClip, b: &HumanClip) -> bool {
    let file = |clip: &HumanClip| (clip.source.file.clone(), clip.source.clip.clone());
    (a.choices.is_cut || b.choices.is_cut) && file(a) == file(b)
}

/// The most alike of all ways to lay two clips over each other, where that is one take.
fn pair(entries: &[Entry], clips: [usize; 2]) -> Option<Pair> {
    let [one, other] = clips.map(|clip| &entries[clip]);
    let retimed: Vec<Entry> = retimed(&one.performance, &other.performance).map(Entry::new).collect();
    let others = std::iter::once((other, false)).chain(retimed.iter().map(|other| (other, true)));
    let ways = others.flat_map(|(other, times_differ)| [false, true].map(|mirrored| (other, mirrored, times_differ)));
    let laid = ways
        .filter_map(|(other, mirrored, times_differ)| Some((laid_over(one, other, mirrored)?, mirrored, times_differ)));
    let found = laid.filter(|(likeness, ..)| is_one_take(likeness));
    let nearest = found.min_by(|(a, ..), (b, ..)| a.unlikeness.total_cmp(&b.unlikeness));
    nearest.map(|(likeness, mirrored, times_differ)| Pair {
        clips,
        mirrored,
        times_differ,
        unlikeness: likeness.unlikeness,
    })
}

fn is_one_take(found: &Likeness) -> bool {
    let limit = UNLIKENESS_MAX * (found.overlap_s / SURE_S).min(1.0);
    found.unlikeness <= limit
        && found.movement_rad >= MOVEMENT_MIN_RAD
        && found.facing_correlation.is_none_or(|correlation| correlation >= FACING_CORRELATION_MIN)
        && turn_alike(found)
}

fn turn_alike(found: &Likeness) -> bool {
    found.turn_difference_rad_s <= TURN_DIFFERENCE_RAD_S.max(TURN_DIFFERENCE_RAD / found.overlap_s)
}

/// The second at the rate that its frames have if they are the first's, where its own frame time says otherwise.
fn retimed<'a>(one: &'a Performance, other: &'a Performance) -> impl Iterator<Item = Performance> + 'a {
    let counts = [one, other].map(|performance| performance.directions.len() as f64);
    let fits = move |ratio: &f64| {
        let count_off = (counts[1] / (ratio * counts[0]) - 1.0).abs();
        let time_off = (other.rate_hz / (ratio * one.rate_hz) - 1.0).abs();
        count_off < COUNT_TOLERANCE && time_off > TIME_TOLERANCE
    };
    FRAME_RATIOS.into_iter().filter(fits).map(|ratio| Performance { rate_hz: ratio * one.rate_hz, ..other.clone() })
}

/// The exact likeness at the best lag; none where the screening finds none.
fn laid_over(one: &Entry, other: &Entry, mirrored: bool) -> Option<Likeness> {
    let lag = nearest_lag(&one.outlines[0], &other.outlines[usize::from(mirrored)])?;
    let coarse = performance::compare(&one.coarse[0], &other.coarse[usize::from(mirrored)], lag)?;
    let swings_alike = coarse.facing_correlation.is_none_or(|correlation| correlation > SCREEN_CORRELATION_MIN);
    if coarse.unlikeness > SCREEN_MAX || !swings_alike || !turn_alike(&coarse) {
        return None;
    }
    let rate_hz = SCREEN_HZ * EXACT_STEPS as f64;
    let other = if mirrored { other.performance.mirrored() } else { other.performance.clone() };
    let (one, other) = (one.performance.sampled(rate_hz), other.sampled(rate_hz));
    let around = (lag - 1) * EXACT_STEPS..=(lag + 1) * EXACT_STEPS;
    let found = around.filter_map(|lag| performance::compare(&one, &other, lag));
    found.min_by(|a, b| a.unlikeness.total_cmp(&b.unlikeness))
}

/// A clip, ready for screening.
struct Entry {
    performance: Performance,
    /// At the screening's rate, as it is and mirrored.
    coarse: [Performance; 2],
    outlines: [Outline; 2],
}

impl Entry {
    fn new(performance: Performance) -> Self {
        let told = performance.sampled(SCREEN_HZ);
        let mirrored = told.mirrored();
        Self { outlines: [Outline::of(&told), Outline::of(&mirrored)], coarse: [told, mirrored], performance }
    }
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

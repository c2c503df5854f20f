//! Duplicates: the same take twice, under another name, at another frame rate, at a wrong frame time, on another
//! skeleton, as a part of the other or mirrored. Of each part of a take one clip gives the example.
//!
//! This file leads through the chapter's steps and reports, for each clip, which other clip gives its examples.

use std::cmp::Reverse;

use motiondb::diagnostic::{Diagnostic, Note, Unfit, Warning};
use rayon::prelude::*;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::dedup::alignment::Alignment;
use crate::dedup::comparison::{ComparedClip, compare};
use crate::dedup::comparison_log::ComparisonLog;
use crate::dedup::groups::{GROUPS_MAX, Groups};
use crate::dedup::shared_windows::{self, Giver, Givers};
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Number of clips that a diagnostic names; it counts the others.
const NAMED_MAX: usize = 8;

/// Two clips of one take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Indices of the clips.
    pub clips: [usize; 2],
    /// The second clip on the first.
    pub alignment: Alignment,
    /// Unlikeness r of both (file `correlation`).
    pub unlikeness: f64,
}

/// Drops from each clip the windows that a better copy of its take gives, and reports it. Comparisons that `log` knows
/// are not made again.
///
/// # Steps
/// 1. Find the groups of one take by motion signatures, the longest clips first.
/// 2. Choose the windows of each group that give examples.
/// 3. Drop the others, with a diagnostic for each clip.
pub(crate) fn drop_duplicates(
    clips: &[HumanClip],
    compared: &[ComparedClip],
    analyzed: &mut [AnalyzedClip],
    body: &HumanBody,
    log: &ComparisonLog,
) {
    let gives_example = |clip: usize| !analyzed[clip].windows.is_empty();
    let may_pair = |a: usize, b: usize| !are_parts_of_one_file(&clips[a], &clips[b]);
    let logged: Vec<Option<usize>> = clips.iter().map(|clip| log.index(clip)).collect();
    let compare = |leader: usize, clip: usize| {
        let of_pair = || compare(&compared[leader], &compared[clip]);
        if may_pair(leader, clip) { log.compared([logged[leader], logged[clip]], of_pair) } else { None }
    };
    let groups = Groups::find(&order(analyzed), gives_example, compare);
    let givers = shared_windows::choose(clips, analyzed, &groups, body, may_pair);
    for (clip, found) in analyzed.iter_mut().enumerate() {
        found.diagnostics.extend(diagnostics(clips, &givers, clip));
        let mut givers = givers.of_windows[clip].iter();
        found.windows.retain(|_| givers.next().is_some_and(Option::is_none));
    }
    for clip in groups.uncompared {
        let warning = Warning::NotCompared { compared: GROUPS_MAX as u32 };
        analyzed[clip].diagnostics.push(Diagnostic::Warning(warning));
    }
}

/// Every two clips of one take, in the clips' order. Compares each clip with each: meant for hundreds of clips.
pub fn pairs(clips: &[HumanClip]) -> Vec<Pair> {
    let compared: Vec<ComparedClip> = clips.par_iter().map(ComparedClip::of).collect();
    let with_later = |first: usize| {
        let pair = |second: usize| {
            if are_parts_of_one_file(&clips[first], &clips[second]) {
                return None;
            }
            let found = compare(&compared[first], &compared[second])?;
            Some(Pair { clips: [first, second], alignment: found.alignment, unlikeness: found.unlikeness })
        };
        (first + 1..clips.len()).filter_map(pair).collect::<Vec<Pair>>()
    };
    (0..clips.len()).into_par_iter().flat_map(with_later).collect()
}

/// The clips, the longest first; those without examples last.
fn order(analyzed: &[AnalyzedClip]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..analyzed.len()).collect();
    // The bits of positive numbers have the numbers' order.
    let key = |found: &AnalyzedClip| (found.windows.is_empty(), Reverse(found.duration_s().to_bits()));
    order.sort_by_cached_key(|&clip| key(&analyzed[clip]));
    order
}

/// The clip that gives this clip's examples; of a clip that gives them, the clips with another frame time.
fn diagnostics(clips: &[HumanClip], givers: &Givers, clip: usize) -> Vec<Diagnostic> {
    let windows = &givers.of_windows[clip];
    let replaced: Vec<&Giver> = windows.iter().flatten().collect();
    let own = match (&replaced[..], windows.len()) {
        ([], 0) => givers.of_clips[clip].map(|giver| same_take(clips, &giver, 0)),
        ([], _) => None,
        ([first, ..], all) if replaced.len() == all => Some(Diagnostic::NoExample(no_example(clips, first))),
        ([first, ..], _) => Some(same_take(clips, first, replaced.len())),
    };
    own.into_iter().chain(of_other_times(clips, givers, clip)).collect()
}

/// Of a clip that gives the examples of a take: the clips that show it at another frame time.
fn of_other_times(clips: &[HumanClip], givers: &Givers, giver: usize) -> Option<Diagnostic> {
    let differs =
        |&clip: &usize| givers.of_clips[clip].is_some_and(|best| best.clip == giver && best.alignment.times_differ());
    let all: Vec<usize> = (0..clips.len()).filter(differs).collect();
    let others: Vec<String> = all.iter().take(NAMED_MAX).map(|&clip| title(&clips[clip])).collect();
    let more = (all.len() - others.len()) as u32;
    let warning = Warning::FrameTimesDiffer { others, more, mirrored: false, windows_left_out: 0 };
    (!all.is_empty()).then_some(Diagnostic::Warning(warning))
}

fn no_example(clips: &[HumanClip], Giver { clip, alignment }: &Giver) -> Unfit {
    Unfit::SameTake {
        other: title(&clips[*clip]),
        mirrored: alignment.mirrored,
        frame_times_differ: alignment.times_differ(),
    }
}

fn same_take(clips: &[HumanClip], Giver { clip, alignment }: &Giver, windows_left_out: usize) -> Diagnostic {
    let (other, mirrored) = (title(&clips[*clip]), alignment.mirrored);
    let windows_left_out = windows_left_out as u32;
    match alignment.times_differ() {
        true => {
            Diagnostic::Warning(Warning::FrameTimesDiffer { others: vec![other], more: 0, mirrored, windows_left_out })
        }
        false => Diagnostic::Note(Note::SameTake { other, mirrored, windows_left_out }),
    }
}

fn title(clip: &HumanClip) -> String {
    format!("{} {}", clip.source.file, clip.source.clip).trim_end().to_owned()
}

/// Whether a manifest cuts both clips out of one capture: then the user wants both.
fn are_parts_of_one_file(a: &HumanClip, b: &HumanClip) -> bool {
    (a.choices.is_cut || b.choices.is_cut) && a.source.file == b.source.file && a.source.clip == b.source.clip
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use motiondb::body::Joint;

    use super::*;
    use crate::cycle::analyzed_clip::AnalyzedClip;
    use crate::cycle::mirrored::mirrored_pose;
    use crate::ground::root_arc::Rates;
    use crate::ground::target_body::target_body;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{SyntheticWalk, idle, performance, walk};

    fn bend() -> SyntheticWalk {
        SyntheticWalk {
            rates: Rates { speed_mps: 0.9, turn_rate_rad_s: 0.5, strafe_mps: 0.0 },
            left_share: 0.53,
            ..SyntheticWalk::default()
        }
    }

    /// Two clips are one take, with this alignment.
    #[track_caller]
    fn check_one_take(one: HumanClip, other: HumanClip, mirrored: bool, times_differ: bool) {
        let found = pairs(&[one, other]);
        assert_eq!(found.len(), 1);
        let Pair { alignment, unlikeness, .. } = found[0];
        assert_eq!((alignment.mirrored, alignment.times_differ()), (mirrored, times_differ), "{found:?}");
        assert!(unlikeness < 0.1, "{found:?}");
    }

    fn mirrored(mut clip: HumanClip) -> HumanClip {
        clip.frames.iter_mut().for_each(|pose: &mut HumanPose| *pose = mirrored_pose(pose));
        clip
    }

    #[test]
    fn resampled_retargeted_cut_and_mirrored_copies_are_found() {
        let original = || walk("original", bend());
        check_one_take(original(), walk("copy", bend()), false, false);
        check_one_take(original(), walk("finer", SyntheticWalk { frame_rate_hz: 100.0, ..bend() }), false, false);
        let giant = Rates { speed_mps: 1.7 * 0.9, ..bend().rates };
        check_one_take(original(), walk("giant", SyntheticWalk { size: 1.7, rates: giant, ..bend() }), false, false);
        let mut part = original();
        part.frames = part.frames[70..200].to_vec();
        check_one_take(original(), part.clone(), false, false);
        check_one_take(mirrored(part), original(), true, false);
    }

    #[test]
    fn a_wrong_frame_time_hides_no_duplicate() {
        let mut slow = walk("slow", bend());
        slow.frame_rate_hz = 25.0;
        check_one_take(slow.clone(), walk("original", bend()), false, true);
        let every_second = walk("coarse", SyntheticWalk { frame_rate_hz: 30.0, ..bend() });
        check_one_take(every_second, slow, false, true);
    }

    #[test]
    fn other_walks_and_standing_are_other_takes() {
        let straight = Rates { turn_rate_rad_s: 0.0, ..bend().rates };
        let clips = [
            walk("bend", bend()),
            walk("straight", SyntheticWalk { rates: straight, ..bend() }),
            walk("quick", SyntheticWalk { period_s: 0.95, ..bend() }),
            walk("slow", SyntheticWalk { period_s: 1.3, ..bend() }),
            idle("idle", 3.0),
        ];
        assert_eq!(pairs(&clips), []);
    }

    /// The bend with both elbows bent further.
    fn with_elbows(bent_deg: f64) -> HumanClip {
        let mut clip = walk("elbows", bend());
        for (joint, side) in [(Joint::LeftForearm, -1.0), (Joint::RightForearm, 1.0)] {
            let turn = DQuat::from_rotation_z(side * bent_deg.to_radians());
            clip.frames.iter_mut().for_each(|pose| pose.rotations[joint.index()] *= turn);
        }
        clip
    }

    #[test]
    fn other_arms_make_another_take() {
        check_one_take(walk("bend", bend()), with_elbows(20.0), false, false);
        check_one_take(mirrored(walk("bend", bend())), with_elbows(20.0), true, false);
        assert_eq!(pairs(&[walk("bend", bend()), with_elbows(70.0)]), []);
        assert_eq!(pairs(&[mirrored(walk("bend", bend())), with_elbows(70.0)]), []);
    }

    /// Begin of each window that is left of each clip, s, and the clip's diagnostics.
    fn left(clips: &[HumanClip]) -> Vec<(Vec<f64>, Vec<Diagnostic>)> {
        let body = target_body(clips).unwrap();
        let mut analyzed: Vec<AnalyzedClip> =
            clips.to_vec().par_iter_mut().map(|clip| AnalyzedClip::of(clip, &body)).collect();
        let compared: Vec<ComparedClip> = clips.iter().map(ComparedClip::of).collect();
        drop_duplicates(clips, &compared, &mut analyzed, &body, &ComparisonLog::default());
        let start_s = |found: &AnalyzedClip| found.windows.iter().map(|window| window.window_s[0]).collect();
        analyzed.iter().map(|found| (start_s(found), found.diagnostics.clone())).collect()
    }

    /// The diagnostic of a clip that another clip replaces.
    fn same_take_as(other: String) -> Diagnostic {
        Diagnostic::NoExample(Unfit::SameTake { other, mirrored: false, frame_times_differ: false })
    }

    /// Of the plain bend and another clip the other gives the example; the bend's diagnostics name it.
    #[track_caller]
    fn check_gives(other: HumanClip) {
        let mut clips = [walk("bend", bend()), other];
        clips.iter_mut().for_each(|clip| clip.source.file = format!("{}.bvh", clip.name));
        let wanted = same_take_as(clips[1].source.file.clone());
        for clips in [clips.clone(), [clips[1].clone(), clips[0].clone()]] {
            let left = left(&clips);
            for (clip, (windows, found)) in clips.iter().zip(left) {
                let is_bend = clip.name == "bend";
                assert_eq!((windows.len(), found.contains(&wanted)), (usize::from(!is_bend), is_bend), "{found:?}");
            }
        }
    }

    #[test]
    fn the_chosen_longer_or_finer_copy_gives_the_example() {
        check_gives(walk("longer", SyntheticWalk { duration_s: 4.4, ..bend() }));
        check_gives(walk("finer", SyntheticWalk { frame_rate_hz: 120.0, ..bend() }));
        let mut chosen = walk("chosen", SyntheticWalk { duration_s: 3.6, ..bend() });
        chosen.choices.is_target_skeleton = true;
        check_gives(chosen);
    }

    #[test]
    fn the_copy_with_human_swings_gives_the_example() {
        let right = || walk("right", SyntheticWalk { duration_s: 8.0, ..bend() });
        for share in [0.5, 2.0] {
            let mut wrong = walk("wrong", SyntheticWalk { duration_s: 8.1, ..bend() });
            wrong.frame_rate_hz *= share;
            for clips in [[right(), wrong.clone()], [wrong, right()]] {
                for (clip, (windows, found)) in clips.iter().zip(left(&clips)) {
                    let gives = clip.name == "right";
                    assert_eq!(windows.len(), usize::from(gives), "{} {found:?}", clip.name);
                    let differs = |found: &Diagnostic| match found {
                        Diagnostic::Warning(Warning::FrameTimesDiffer { .. }) => gives,
                        Diagnostic::NoExample(Unfit::SameTake { frame_times_differ, .. }) => *frame_times_differ,
                        _ => false,
                    };
                    assert!(found.iter().any(differs), "{found:?}");
                }
            }
        }
    }

    /// The clip with a root that runs ahead of the feet from a frame on.
    fn sliding_from(mut clip: HumanClip, first: usize) -> HumanClip {
        let ahead_m = 0.35 / clip.frame_rate_hz;
        clip.frames.iter_mut().skip(first).enumerate().for_each(|(frame, pose)| {
            pose.pelvis_m.x += ahead_m * frame as f64;
        });
        clip
    }

    #[test]
    fn a_part_clean_only_in_the_worse_copy_stays() {
        let turn = Rates { speed_mps: 0.6, turn_rate_rad_s: 0.9, strafe_mps: 0.0 };
        let parts = [
            walk("part", SyntheticWalk { duration_s: 6.0, ..SyntheticWalk::default() }),
            walk("part", SyntheticWalk { rates: turn, ..bend() }),
        ];
        let clean = performance("clean", &parts);
        let longer = [&parts[..], &[idle("part", 2.0)]].concat();
        let spoiled = sliding_from(performance("spoiled", &longer), 355);
        let left = left(&[clean, spoiled]);
        let [(of_clean, found), (of_spoiled, _)] = &left[..] else { panic!("{left:?}") };
        assert!(of_clean.iter().any(|start_s| *start_s > 5.0), "{left:?}");
        assert_eq!(of_clean.iter().chain(of_spoiled).filter(|start_s| **start_s < 5.0).count(), 1, "{left:?}");
        assert!(matches!(found[..], [] | [Diagnostic::Note(Note::SameTake { .. })]), "{left:?}");
    }

    #[test]
    fn one_of_300_copies_gives_the_example() {
        let copy = |index: usize| {
            let mut clip = walk(&format!("{index:03}"), bend());
            clip.source.file = clip.name.clone();
            clip.frames.drain(..index % 23);
            if index % 3 == 1 { mirrored(clip) } else { clip }
        };
        let clips: Vec<HumanClip> = (0..300).map(copy).collect();
        let left = left(&clips);
        let givers: Vec<usize> = (0..300).filter(|&clip| !left[clip].0.is_empty()).collect();
        assert_eq!(givers.len(), 1);
        let giver = &clips[givers[0]].name;
        for (clip, (_, found)) in left.iter().enumerate().filter(|(clip, _)| *clip != givers[0]) {
            let [Diagnostic::NoExample(Unfit::SameTake { other, .. })] = &found[..] else { panic!("{found:?}") };
            assert_eq!(other, giver, "{clip}");
        }
        assert_eq!(left[givers[0]].1, []);
    }

    #[test]
    fn parts_cut_from_one_file_are_no_duplicates() {
        let part = |name: &str| {
            let mut clip = walk(name, bend());
            clip.source.file = "capture.bvh".into();
            clip.choices.is_cut = true;
            clip
        };
        assert_eq!(pairs(&[part("one"), part("other")]), []);
    }

    #[test]
    fn clips_of_few_frames_match_nothing() {
        let first_frames = |count: usize| {
            let mut clip = walk("short", bend());
            clip.frames.truncate(count);
            clip
        };
        assert_eq!(pairs(&[1, 2, 3, 4, 1, 2, 3, 4].map(first_frames)), []);
    }
}

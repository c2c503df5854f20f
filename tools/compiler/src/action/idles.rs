//! AnalyzedClips → the idles of a set: rests of bodies at ease, closed into loops, the best first.
//!
//! The best rest has the fewest flaws ([`crate::cycle::flaws`]): long, arms down, calm, in a clip of a telling name
//! without warnings. Rests of a clip whose standing window is a worse copy of another take are left out.

use std::ops::Range;

use motiondb::motion::ActionKind;
use rayon::prelude::*;

use crate::action::cut_action::CutAction;
use crate::action::idle_loop::{IdleLoop, idle_loop};
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::flaws::{flaws_of_rest, standing_flaws};
use crate::cycle::rest::Rest;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::named_cycles::window_name;

/// Greatest number of idles of a set: a row of bodies in which hardly two neighbours stand alike.
const IDLES_MAX: usize = 8;

/// A rest that may become an idle.
struct RestCandidate {
    /// Index of its clip.
    clip: usize,
    frames: Range<usize>,
    flaws: f64,
}

/// The idles of all clips, the best first.
pub(crate) fn idles(clips: &[HumanClip], analyzed: &[AnalyzedClip], body: &HumanBody) -> Vec<CutAction> {
    let of_clip = |clip: usize| rest_candidates(clip, &clips[clip], &analyzed[clip], body);
    let mut rests: Vec<RestCandidate> = (0..clips.len()).into_par_iter().flat_map(of_clip).collect();
    rests.sort_by(|a, b| a.flaws.total_cmp(&b.flaws).then((a.clip, a.frames.start).cmp(&(b.clip, b.frames.start))));
    rests.truncate(IDLES_MAX);
    rests.par_iter().map(|rest| idle(rest, &clips[rest.clip], &analyzed[rest.clip], body)).collect()
}

/// The rests of a clip in which the body stands at ease.
fn rest_candidates(index: usize, clip: &HumanClip, found: &AnalyzedClip, body: &HumanBody) -> Vec<RestCandidate> {
    if found.windows.iter().all(|window| window.stepping().is_some()) {
        return Vec::new();
    }
    let candidate = |frames: &Range<usize>| {
        let rest = Rest::of(&found.grounded, frames, body);
        let flaws = flaws_of_rest(&rest) + standing_flaws(clip);
        rest.unfit().is_none().then(|| RestCandidate { clip: index, frames: frames.clone(), flaws })
    };
    found.rests.iter().filter_map(candidate).collect()
}

fn idle(rest: &RestCandidate, clip: &HumanClip, found: &AnalyzedClip, body: &HumanBody) -> CutAction {
    let IdleLoop { frames, poses } = idle_loop(&found.grounded, body, &rest.frames);
    let window_s = found.in_file_s(clip, frames);
    let is_whole = found.windows.len() == 1 && found.rests.len() == 1;
    CutAction {
        name: window_name(clip, found.frame_count, usize::from(!is_whole), window_s),
        kind: ActionKind::Idle,
        source: rest.clip as u32,
        window_s,
        contacts: vec![[1.0; 2]; poses.len()],
        poses,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use glam::DQuat;
    use motiondb::body::Joint;
    use motiondb::diagnostic::{Diagnostic, Note, Unfit};

    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{SyntheticWalk, database_of, idle, performance, swaying, walk};

    fn names(clips: Vec<HumanClip>) -> Vec<String> {
        database_of(clips, 0).idles().map(|idle| idle.name.clone()).collect()
    }

    /// A body that stands with its arms turned up from hanging, about the forward axis and then about the left one.
    fn with_arms(name: &str, duration_s: f64, out_rad: f64, forward_rad: f64) -> HumanClip {
        let mut clip = idle(name, duration_s);
        for pose in &mut clip.frames {
            for (joint, sign) in [(Joint::LeftUpperArm, 1.0), (Joint::RightUpperArm, -1.0)] {
                let hanging = DQuat::from_rotation_x(sign * (out_rad - FRAC_PI_2));
                pose.rotations[joint.index()] = DQuat::from_rotation_y(-forward_rad) * hanging;
            }
        }
        clip
    }

    #[test]
    fn bind_poses_and_aimed_guns_are_no_idles() {
        for (name, out_rad, forward_rad, wanted) in [
            ("t_pose", FRAC_PI_2, 0.0, Unfit::TPose),
            ("a_pose", 0.75, 0.0, Unfit::ArmsOut),
            ("aim", 0.1, 1.5, Unfit::ArmRaised),
        ] {
            let clips = vec![
                walk("walk", SyntheticWalk::default()),
                idle("idle", 3.0),
                with_arms(name, 9.0, out_rad, forward_rad),
            ];
            let db = database_of(clips, 0);
            assert_eq!(db.idles().map(|idle| idle.name.as_str()).collect::<Vec<_>>(), ["idle"], "{name}");
            assert!(!db.examples.iter().any(|example| example.name == name), "{name}");
            let source = db.sources.iter().find(|source| source.file == format!("{name}.bvh")).unwrap();
            assert!(source.diagnostics.contains(&Diagnostic::NoExample(wanted)), "{:?}", source.diagnostics);
        }
    }

    #[test]
    fn a_t_pose_between_walks_is_noted() {
        let walk = || walk("part", SyntheticWalk::default());
        let clip = performance("capture", &[walk(), with_arms("part", 3.0, FRAC_PI_2, 0.0), walk()]);
        let db = database_of(vec![clip], 0);
        let found = &db.sources[0].diagnostics;
        let is_noted = |found: &Diagnostic| match found {
            Diagnostic::Note(Note::RestsLeftOut { longest_s: [from_s, to_s], reason: Unfit::TPose, more: 0 }) => {
                (from_s - 4.0).abs() < 0.6 && (to_s - 7.0).abs() < 0.6
            }
            _ => false,
        };
        assert!(found.iter().any(is_noted), "{found:?}");
        assert_eq!(db.idles().count(), 0);
    }

    #[test]
    fn arms_that_hang_or_are_held_in_front_make_idles() {
        for (out_rad, forward_rad) in [(0.1, 0.0), (0.35, 0.0), (0.1, 0.6)] {
            assert_eq!(names(vec![with_arms("guard", 4.0, out_rad, forward_rad)]), ["guard"]);
        }
    }

    #[test]
    fn idles_keep_their_length_and_the_best_is_first() {
        let parts = [swaying("part", 4.0, 1.7), walk("part", SyntheticWalk::default()), swaying("part", 6.0, 2.3)];
        let clips = vec![
            walk("walk", SyntheticWalk::at(0.8, 0.0, 0.0)),
            swaying("long", 9.0, 2.9),
            swaying("idle", 7.0, 1.3),
            performance("capture", &parts),
        ];
        let db = database_of(clips, 0);
        let idles: Vec<_> = db.idles().collect();
        assert_eq!(idles.len(), 4, "{:?}", idles.iter().map(|idle| &idle.name).collect::<Vec<_>>());
        assert_eq!([&idles[0].name, &idles[1].name], ["idle", "long"]);
        assert!(idles[2].name.starts_with("capture@") && idles[3].name.starts_with("capture@"));
        for idle in idles {
            let [first_s, last_s] = idle.window_s;
            assert!((idle.duration_s() - (last_s - first_s)).abs() < 0.02, "{}: {} s", idle.name, idle.duration_s());
            assert!(idle.duration_s() > 1.5, "{}: {} s", idle.name, idle.duration_s());
            assert_eq!(db.examples[idle.entry.example as usize].key_times_s, None);
        }
    }

    #[test]
    fn at_most_eight_idles_are_kept() {
        let clips = (0..12).map(|index| swaying(&format!("idle{index}"), 5.0, 1.0 + 0.17 * f64::from(index))).collect();
        assert_eq!(names(clips).len(), 8);
    }
}

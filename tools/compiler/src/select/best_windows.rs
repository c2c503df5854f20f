//! AnalyzedClip → which of its steady windows become examples: of near-equal windows the best.
//!
//! 1. Of the windows of one clip that are near-equal and in which trunk or arms are held otherwise ([`Carriage`]), one
//!    carriage stays: by flaws, posture penalty ([`posture_penalty_mps`]) and duration.
//! 2. Among those that lie in one cell of a grid in (v_f, ω_t, ω_s) ([`rate_cells`]), the one with the fewest flaws
//!    stays ([`crate::cycle::flaws`]). The longest of the rest always stays as the clip's own example: the user gave
//!    the clip.
//! 3. Every further window must add to the set: by its flaws, the best first, a window stays that is near-equal to no
//!    example so far.

use glam::DVec3;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::rate_cells;
use crate::cycle::steady_cycle::{SteadyCycle, SteadyMotion};
use crate::retarget::human_clip::HumanBody;
use crate::rig::carriage::Carriage;
use crate::select::posture_penalty::posture_penalty_mps;

/// Posture penalty as bad as a flaw of 1, m/s: the width of a cell.
const PENALTY_MPS: f64 = 0.25;

/// Keeps the first window of a clip and of the others those that are beyond doubt; of each cell the best. They stay in
/// their order, the longest first.
pub(crate) fn best_windows(mut clip: AnalyzedClip, body: &HumanBody) -> AnalyzedClip {
    let found = clip.windows.len();
    let mut index = 0..;
    clip.windows.retain(|window| index.next() == Some(0) || !window.is_doubtful);
    clip.left_out.doubtful += found - clip.windows.len();
    leave_out_other_carriages(&mut clip, body);
    let windows = &mut clip.windows;
    let clean = windows.len();
    let cells: Vec<(bool, DVec3)> = windows.iter().map(cell).collect();
    let flaws: Vec<f64> = windows.iter().map(|window| window.flaws).collect();
    let is_best = |index: usize| {
        let others = (0..clean).filter(|other| cells[*other] == cells[index]);
        others.min_by(|a, b| flaws[*a].total_cmp(&flaws[*b])) == Some(index)
    };
    let mut index = 0..;
    windows.retain(|_| index.next().is_some_and(is_best));
    clip.left_out.near_equal += clean - windows.len();
    clip
}

/// Drops, and counts, the windows of a clip that step as another one does, but with another carriage.
fn leave_out_other_carriages(clip: &mut AnalyzedClip, body: &HumanBody) {
    let windows = &clip.windows;
    let carriages: Vec<Option<Carriage>> =
        windows.iter().map(|window| window.stepping().map(|cycle| cycle.carriage(body))).collect();
    let differ = |a: usize, b: usize| {
        let is_near = are_near_equal(&windows[a], &windows[b]) || cell(&windows[a]) == cell(&windows[b]);
        is_near && carriages[a].zip(carriages[b]).is_some_and(|(a, b)| !a.is_like(&b))
    };
    if !(0..windows.len()).any(|a| (0..a).any(|b| differ(a, b))) {
        return;
    }
    let duration_s = |index: usize| windows[index].window_s[1] - windows[index].window_s[0];
    let near = |index: usize| {
        (0..windows.len()).filter(move |&other| other == index || are_near_equal(&windows[index], &windows[other]))
    };
    let badness = |index: usize| {
        let penalty_mps = windows[index].stepping().map_or(0.0, |cycle| posture_penalty_mps(cycle, body));
        let unlike_s: f64 = near(index).filter(|&other| differ(index, other)).map(duration_s).sum();
        let all_s: f64 = near(index).map(duration_s).sum();
        windows[index].flaws + penalty_mps / PENALTY_MPS + unlike_s / all_s
    };
    let badness: Vec<f64> = (0..windows.len()).map(badness).collect();
    let mut order: Vec<usize> = (0..windows.len()).collect();
    order.sort_by(|a, b| badness[*a].total_cmp(&badness[*b]));
    let mut kept: Vec<usize> = Vec::new();
    for index in order {
        if !kept.iter().any(|&better| differ(better, index)) {
            kept.push(index);
        }
    }
    kept.sort_unstable();
    let mut index = 0..;
    let (kept, left_out) = std::mem::take(&mut clip.windows)
        .into_iter()
        .partition(|_| index.next().is_some_and(|index: usize| kept.binary_search(&index).is_ok()));
    clip.windows = kept;
    clip.left_out.add_of_other_carriage(&left_out);
}

/// Drops, and counts, the windows of all clips that add nothing to the set.
pub(crate) fn windows_that_add(mut clips: Vec<AnalyzedClip>) -> Vec<AnalyzedClip> {
    let mut kept: Vec<[usize; 2]> =
        (0..clips.len()).filter(|&clip| !clips[clip].windows.is_empty()).map(|clip| [clip, 0]).collect();
    let mut others: Vec<[usize; 2]> =
        (0..clips.len()).flat_map(|clip| (1..clips[clip].windows.len()).map(move |window| [clip, window])).collect();
    let window = |[clip, window]: [usize; 2]| &clips[clip].windows[window];
    others.sort_by(|a, b| window(*a).flaws.total_cmp(&window(*b).flaws).then(a.cmp(b)));
    for other in others {
        if !kept.iter().any(|kept| are_near_equal(window(*kept), window(other))) {
            kept.push(other);
        }
    }
    kept.sort_unstable();
    for (clip, analyzed) in clips.iter_mut().enumerate() {
        let found = analyzed.windows.len();
        let mut index = 0..;
        analyzed.windows.retain(|_| index.next().is_some_and(|window| kept.binary_search(&[clip, window]).is_ok()));
        analyzed.left_out.near_equal += found - analyzed.windows.len();
    }
    clips
}

/// Whether a window stands, and the middle of its cell.
fn cell(window: &SteadyCycle) -> (bool, DVec3) {
    (is_standing(window), rate_cells::cell_middle(&window.rates()))
}

fn is_standing(window: &SteadyCycle) -> bool {
    matches!(window.motion, SteadyMotion::Stands(_))
}

fn are_near_equal(a: &SteadyCycle, b: &SteadyCycle) -> bool {
    is_standing(a) == is_standing(b) && rate_cells::are_near_equal(&a.rates(), &b.rates())
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use motiondb::body::Joint;
    use motiondb::diagnostic::{Diagnostic, Note};
    use motiondb::motion::MotionExample;

    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{SyntheticWalk, database_of, idle, performance, recorded, walk};

    fn part(speed_mps: f64, turn_rate_rad_s: f64, duration_s: f64) -> HumanClip {
        walk("part", SyntheticWalk { duration_s, ..SyntheticWalk::at(speed_mps, turn_rate_rad_s, 0.0) })
    }

    #[track_caller]
    fn check(example: &MotionExample, name: &str, parameters: [f32; 3], window_s: [f32; 2]) {
        assert_eq!(example.name, name);
        let found = example.parameters.to_vec3().to_array();
        assert!(found.iter().zip(parameters).all(|(found, exact)| (found - exact).abs() < 0.04), "{example:?}");
        let [start_s, end_s] = example.window_s;
        assert!(start_s >= window_s[0] - 0.1 && end_s <= window_s[1] + 0.1, "{example:?}");
        assert!(end_s - start_s > 0.4 * (window_s[1] - window_s[0]), "{example:?}");
    }

    #[test]
    fn steady_parts_are_named_by_their_second() {
        let parts = [part(0.7, 0.0, 6.0), idle("part", 3.0), part(1.3, 0.0, 5.0), part(0.8, 0.8, 4.0)];
        let db = database_of(vec![performance("capture", &parts)], 0);
        let [slow, rest, fast, turn] = recorded(&db)[..] else { panic!("{:#?}", db.examples) };
        check(slow, "capture", [0.7, 0.0, 0.0], [0.0, 6.0]);
        check(rest, &format!("capture@{:04.1}s", rest.window_s[0]), [0.0; 3], [6.0, 9.0]);
        check(fast, &format!("capture@{:04.1}s", fast.window_s[0]), [1.3, 0.0, 0.0], [9.0, 14.1]);
        check(turn, &format!("capture@{:04.1}s", turn.window_s[0]), [0.8, 0.8, 0.0], [14.0, 18.1]);
        assert_eq!(rest.key_times_s, None);
        assert!(db.examples.iter().any(|example| example.name == format!("{}_mirrored", turn.name)));
    }

    /// A walk at 1.2 m/s whose root gets ahead of its feet.
    fn sliding(duration_s: f64) -> HumanClip {
        let mut clip = part(1.2, 0.0, duration_s);
        let ahead_m = clip.frames[1].pelvis_m - clip.frames[0].pelvis_m;
        let ahead_m = ahead_m.with_z(0.0).normalize() * 0.1 / clip.frame_rate_hz;
        clip.frames.iter_mut().enumerate().for_each(|(frame, pose)| pose.pelvis_m += ahead_m * frame as f64);
        clip
    }

    #[test]
    fn of_near_equal_windows_the_least_flawed_stays() {
        let between = part(0.7, 0.9, 4.0);
        for parts in
            [[part(1.2, 0.0, 4.0), between.clone(), sliding(5.0)], [sliding(5.0), between, part(1.2, 0.0, 4.0)]]
        {
            let db = database_of(vec![performance("capture", &parts)], 0);
            let straight: Vec<_> = recorded(&db).into_iter().filter(|e| e.parameters.turn_rate_rad_s == 0.0).collect();
            assert_eq!(straight.len(), 1, "{straight:#?}");
            assert!(straight[0].planted_slide_cm_s < 2.0, "{straight:?}");
            let left_out = Diagnostic::Note(Note::WindowsLeftOut { near_equal: 1, doubtful: 0 });
            assert!(db.sources[0].diagnostics.contains(&left_out), "{:?}", db.sources);
        }
    }

    #[test]
    fn of_near_equal_windows_the_plain_carriage_stays() {
        let raised = |mut clip: HumanClip| {
            for pose in &mut clip.frames {
                for arm in [Joint::LeftUpperArm, Joint::RightUpperArm] {
                    let arm = &mut pose.rotations[arm.index()];
                    *arm = DQuat::from_rotation_y(-2.5) * *arm;
                }
            }
            clip
        };
        let (plain, between) = (part(1.2, 0.0, 4.0), part(0.7, 0.9, 4.0));
        for others_mps in [1.2, 1.15, 1.08] {
            let other = raised(part(others_mps, 0.0, 6.0));
            for parts in [[plain.clone(), between.clone(), other.clone()], [other, between.clone(), plain.clone()]] {
                let db = database_of(vec![performance("capture", &parts)], 0);
                let straight: Vec<_> =
                    recorded(&db).into_iter().filter(|e| e.parameters.turn_rate_rad_s == 0.0).collect();
                assert_eq!(straight.len(), 1, "{straight:#?}");
                assert!((straight[0].parameters.speed_mps - 1.2).abs() < 0.02, "{straight:?}");
                let is_note =
                    |found: &Diagnostic| matches!(found, Diagnostic::Note(Note::CarriageLeftOut { windows: 1, .. }));
                assert!(db.sources[0].diagnostics.iter().any(is_note), "{:?}", db.sources);
            }
        }
    }

    #[test]
    fn further_windows_must_add_to_the_set() {
        let clip = |name: &str, speed_mps, turn_rate_rad_s, period_s| {
            walk(name, SyntheticWalk { period_s, ..SyntheticWalk::at(speed_mps, turn_rate_rad_s, 0.0) })
        };
        let db = database_of(
            vec![
                performance("capture", &[part(1.2, 0.0, 6.0), part(0.7, 0.9, 4.0)]),
                clip("walk", 1.2, 0.0, 1.0),
                clip("same", 1.25, 0.0, 1.2),
                clip("turn", 0.7, 0.85, 1.0),
            ],
            0,
        );
        let names: Vec<&str> = recorded(&db).iter().map(|example| example.name.as_str()).collect();
        assert_eq!(names, ["capture", "same", "turn", "walk"]);
    }
}

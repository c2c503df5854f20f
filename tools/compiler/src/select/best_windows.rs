//! AnalyzedClip → which of its steady windows become examples: of near-equal windows the best.
//!
//! 1. Of the windows of one clip that are near-equal, but differ in trunk and arms ([`Carriage`]) or in the posture penalty
//!    ([`crate::select::posture_penalty`]), one carriage stays: by flaws of window and posture, and by the share of the time
//!    with other carriages.
//! 2. Among those that lie in one cell of a grid in (v_f, ω_t, ω_s) ([`rate_cells`]), the one with the fewest flaws
//!    stays ([`crate::cycle::flaws`]). The longest of the rest always stays as the clip's own example: the user gave
//!    the clip.
//! 3. Every further window must add to the set: by its flaws, the best first, a window stays that is near-equal to no
//!    example so far.

use glam::DVec3;
use motiondb::velocity_sets::velocity_hull::goes_straight;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::rate_cells;
use crate::cycle::steady_cycle::{SteadyCycle, SteadyMotion};
use crate::retarget::human_clip::HumanBody;
use crate::rig::carriage::Carriage;
use crate::select::posture_penalty::posture_flaws;

/// Least difference of the posture flaws of two carriages that go straight: legs that are bent or limp.
const POSTURES_APART: f64 = 0.4;
/// Flaws of a window if all others of its velocity have another carriage.
const RARITY_FLAWS: f64 = 0.3;

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

/// A window that steps, as far as its carriage matters.
struct CarriedWindow {
    carriage: Carriage,
    /// Its posture penalty as flaws.
    posture_flaws: f64,
    goes_straight: bool,
}

impl CarriedWindow {
    fn of(window: &SteadyCycle, body: &HumanBody) -> Option<Self> {
        let cycle = window.stepping()?;
        Some(Self {
            carriage: cycle.carriage(body),
            posture_flaws: posture_flaws(cycle, body),
            goes_straight: goes_straight(&cycle.rates.to_parameters()),
        })
    }

    /// Whether the body holds trunk, arms or legs otherwise.
    fn differs(&self, other: &Self) -> bool {
        let go_straight = self.goes_straight && other.goes_straight;
        !self.carriage.is_like(&other.carriage)
            || go_straight && (self.posture_flaws - other.posture_flaws).abs() > POSTURES_APART
    }
}

/// Drops, and counts, the windows of a clip that step at the velocity of another, but with another carriage: the one with
/// more flaws of window and posture, and the rarer one.
fn leave_out_other_carriages(clip: &mut AnalyzedClip, body: &HumanBody) {
    let windows = &clip.windows;
    if windows.len() < 2 {
        return;
    }
    let carried: Vec<Option<CarriedWindow>> = windows.iter().map(|window| CarriedWindow::of(window, body)).collect();
    let cells: Vec<(bool, DVec3)> = windows.iter().map(cell).collect();
    let is_near = |a: usize, b: usize| cells[a] == cells[b] || are_near_equal(&windows[a], &windows[b]);
    let differ = |a: usize, b: usize| {
        let both = carried[a].as_ref().zip(carried[b].as_ref()).filter(|_| is_near(a, b));
        both.is_some_and(|(one, other)| one.differs(other))
    };
    let duration_s = |index: usize| windows[index].window_s[1] - windows[index].window_s[0];
    let badness = |index: usize| {
        let near: Vec<usize> = (0..windows.len()).filter(|&other| is_near(index, other)).collect();
        let all_s: f64 = near.iter().map(|&other| duration_s(other)).sum();
        let unlike_s: f64 = near.iter().filter(|&&other| differ(index, other)).map(|&other| duration_s(other)).sum();
        let posture_flaws = carried[index].as_ref().map_or(0.0, |window| window.posture_flaws);
        windows[index].flaws + posture_flaws + RARITY_FLAWS * unlike_s / all_s
    };
    let badness: Vec<f64> = (0..windows.len()).map(badness).collect();
    let mut order: Vec<usize> = (0..windows.len()).collect();
    order.sort_by(|a, b| badness[*a].total_cmp(&badness[*b]));
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for index in order {
        match kept.iter().find(|&&better| differ(better, index)) {
            Some(&better) => left_out.push([windows[index].window_s, windows[better].window_s]),
            None => kept.push(index),
        }
    }
    kept.sort_unstable();
    let mut index = 0..;
    clip.windows.retain(|_| index.next().is_some_and(|index: usize| kept.binary_search(&index).is_ok()));
    clip.left_out.add_other_carriages(&left_out);
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

//! The transitions of a set.
//!
//! # Steps
//! 1. Join each movement of each clip to the examples where it fits them best.
//! 2. Of near-equal transitions keep the best.
//! 3. Add the mirror images of those without a counterpart.
//! 4. Name them: the clip's name and the kind, and the second of the file where a clip has several of a kind.

use motiondb::motion::ActionKind;
use rayon::prelude::*;

use crate::action::joined_action::JoinedAction;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::error::CompileError;
use crate::gait::movements::{Movement, MovementKind};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::named_cycles::{NamedCycle, standing, window_name};
use crate::transition::example_rows::ExampleRows;
use crate::transition::recorded_transition::{RecordedTransition, TransitionClip, recorded_transition};
use crate::transition::selection::{best_transitions, needs_mirror};

/// The transitions of a set, by kind. A set without a standing example has none of those that begin or end at
/// rest.
///
/// # Errors
/// If a clip does not show the transition that its manifest states.
pub(crate) fn transitions(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    cycles: &[NamedCycle],
    body: &HumanBody,
) -> Result<Vec<JoinedAction>, CompileError> {
    let rows = ExampleRows::of(cycles, standing(cycles), body);
    let of_clip = |index: usize| of_clip(index, &clips[index], &analyzed[index], &rows, body);
    let found: Vec<Vec<RecordedTransition>> = (0..clips.len()).into_par_iter().map(of_clip).collect();
    if let Some((clip, kind)) = unfulfilled(clips, &found) {
        return Err(CompileError::NoTransition { file: clip.source.file.clone(), kind });
    }
    let recorded = best_transitions(found.into_iter().flatten().collect());
    let mirror = |found: &RecordedTransition| {
        let requested = clips[found.source].choices.mirror;
        if !requested.unwrap_or_else(|| needs_mirror(found, &recorded)) {
            return None;
        }
        let clip = TransitionClip {
            index: found.source,
            found: &analyzed[found.source],
            mirrored: true,
            stated: clips[found.source].choices.transition,
        };
        let kind = MovementKind::of(found.kind);
        // The mirror image is cut where the original is.
        let movement = Movement { kind, cuts: vec![found.cut], is_cut: [false; 2] };
        recorded_transition(&clip, &movement, &rows, body)
    };
    let mirrors: Vec<RecordedTransition> = recorded.iter().filter_map(mirror).collect();
    let mut all: Vec<RecordedTransition> = recorded.into_iter().chain(mirrors).collect();
    all.sort_by_key(|found| (found.kind, found.source, found.cut[0].to_bits(), found.mirrored));
    let names: Vec<String> = all.iter().map(|found| name(found, &all, clips, analyzed)).collect();
    Ok(all.into_iter().zip(names).map(|(found, name)| joined(found, name, clips, analyzed)).collect())
}

/// The first clip without the transition that its manifest states, and that kind.
fn unfulfilled<'a>(clips: &'a [HumanClip], found: &[Vec<RecordedTransition>]) -> Option<(&'a HumanClip, ActionKind)> {
    clips.iter().zip(found).find_map(|(clip, found)| {
        let kind = clip.choices.transition?;
        found.is_empty().then_some((clip, kind))
    })
}

/// The transitions of a clip.
fn of_clip(
    index: usize,
    clip: &HumanClip,
    analyzed: &AnalyzedClip,
    rows: &ExampleRows,
    body: &HumanBody,
) -> Vec<RecordedTransition> {
    let stated = clip.choices.transition;
    let source = TransitionClip { index, found: analyzed, mirrored: false, stated };
    let found: Vec<RecordedTransition> =
        analyzed.movements.iter().filter_map(|movement| recorded_transition(&source, movement, rows, body)).collect();
    if let Some(kind) = stated {
        return found.into_iter().filter(|transition| transition.kind == kind).collect();
    }
    let is_within = |part: &RecordedTransition| {
        let between = found.iter().filter(|other| MovementKind::of(other.kind) == MovementKind::Between);
        between.into_iter().any(|whole| whole.cut[0] <= part.cut[0] && part.cut[1] <= whole.cut[1])
    };
    // The first steps of a turn on the spot are no start.
    let is_whole =
        |part: &&RecordedTransition| MovementKind::of(part.kind) == MovementKind::Between || !is_within(part);
    found.iter().filter(is_whole).cloned().collect()
}

/// First and last second of a transition in its file.
fn window_s(found: &RecordedTransition, clips: &[HumanClip], analyzed: &[AnalyzedClip]) -> [f64; 2] {
    analyzed[found.source].in_file_s(&clips[found.source], found.cut)
}

fn name(
    found: &RecordedTransition,
    all: &[RecordedTransition],
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
) -> String {
    let clip = &clips[found.source];
    let alike = all
        .iter()
        .filter(|other| other.source == found.source && other.kind == found.kind && other.mirrored == found.mirrored);
    let window_s = window_s(found, clips, analyzed);
    let window = window_name(clip, analyzed[found.source].frame_count, usize::from(alike.count() > 1), window_s);
    let second = window.strip_prefix(clip.name.as_str()).unwrap_or_default();
    let mirrored = if found.mirrored { "_mirrored" } else { "" };
    format!("{}_{}{second}{mirrored}", clip.name, found.kind.name())
}

fn joined(found: RecordedTransition, name: String, clips: &[HumanClip], analyzed: &[AnalyzedClip]) -> JoinedAction {
    let phases = found.phases();
    JoinedAction {
        name,
        kind: found.kind,
        source: found.source as u32,
        window_s: window_s(&found, clips, analyzed),
        mirrored: found.mirrored,
        ends: [0, 1].map(|end| (found.ends[end].example, phases[end])),
        frames: found.frames,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use glam::{DQuat, DVec2, Vec2};
    use motiondb::body::Joint;
    use motiondb::diagnostic::{Diagnostic, Note};
    use motiondb::motion::{Action, MotionDb};
    use motiondb::validate::first_broken;

    use super::*;
    use crate::ground::root_arc::{Rates, RootArc};
    use crate::ground::rotations::ground_rotation;
    use crate::synthetic::{SyntheticWalk, database_of, idle, steps, walk};
    use crate::{Options, compile};

    /// 0 before a time, 1 after another, smooth between.
    fn ramp(time_s: f64, [from_s, to_s]: [f64; 2]) -> f64 {
        let share = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }

    /// The integral of [`ramp`].
    fn ramp_integral(time_s: f64, [from_s, to_s]: [f64; 2]) -> f64 {
        let share = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        (to_s - from_s) * (share * share * share * (1.0 - 0.5 * share)) + (time_s - to_s).max(0.0)
    }

    fn set(clip: HumanClip) -> MotionDb {
        let walks = [0.7, 1.2].map(|speed| walk(&format!("walk_{speed}"), SyntheticWalk::at(speed, 0.0, 0.0)));
        let db = database_of(walks.into_iter().chain([idle("idle", 3.0), clip]).collect(), 0);
        assert_eq!(first_broken(&db), None);
        db
    }

    /// The recorded transitions of a clip beside two walks and an idle.
    fn recorded(db: &MotionDb) -> Vec<&Action> {
        db.actions.iter().filter(|action| action.kind != ActionKind::Idle && !action.mirrored).collect()
    }

    /// Checks that a clip has one transition of this kind, which travels as the root of the plan does, and its mirror.
    #[track_caller]
    fn check(kind: ActionKind, clip: HumanClip, root: impl Fn(f64) -> (DVec2, f64)) -> MotionDb {
        let db = set(clip);
        let [found] = recorded(&db)[..] else {
            panic!("{:?}", db.actions.iter().map(|a| (&a.name, a.window_s)).collect::<Vec<_>>())
        };
        assert_eq!(found.kind, kind);
        let [(first_m, first_rad), (last_m, last_rad)] = found.window_s.map(|time_s| root(f64::from(time_s)));
        let wanted_m = (ground_rotation(-first_rad) * (last_m - first_m)).as_vec2();
        let (moved_m, turn_rad) = (found.displacement_m(), found.turn_rad());
        // A body that comes out of a turn stands a little inward of its root.
        let [limit_m, limit_rad] = if kind == ActionKind::Pivot { [0.08, 0.15] } else { [0.05, 0.1] };
        assert!(moved_m.distance(wanted_m) < limit_m, "{moved_m}, not {wanted_m}, in {:?}", found.window_s);
        assert!(
            (f64::from(turn_rad) - (last_rad - first_rad)).abs() < f64::from(limit_rad),
            "{turn_rad}, not {}",
            last_rad - first_rad
        );
        let mirror = db.actions.iter().find(|action| action.mirrored).unwrap();
        assert_eq!((mirror.kind, mirror.name.clone()), (kind, format!("{}_mirrored", found.name)));
        assert!(mirror.displacement_m().distance(moved_m * Vec2::new(1.0, -1.0)) < 0.03);
        assert!((mirror.turn_rad() + turn_rad).abs() < 0.06);
        db
    }

    /// Name and speed of the example at each end.
    fn speeds_mps(db: &MotionDb) -> [f32; 2] {
        let found = recorded(db)[0];
        [found.entry, found.exit].map(|end| db.examples[end.example as usize].parameters.speed_mps)
    }

    #[test]
    fn a_start_ends_in_the_walk_that_it_leads_to() {
        let root = |time_s: f64| (DVec2::new(1.2 * ramp_integral(time_s, [1.0, 1.9]), 0.3), 0.0);
        let mids_s = [&[0.5, 1.75, 2.85, 3.95][..], &[0.2, 2.3, 3.4, 4.5][..]];
        let db = check(ActionKind::Start, steps("go", 4.2, root, mids_s), root);
        let [from_mps, to_mps] = speeds_mps(&db);
        assert!(from_mps == 0.0 && (to_mps - 1.2).abs() < 0.02, "{from_mps}, {to_mps}");
    }

    #[test]
    fn a_stop_begins_in_the_walk_that_it_leaves() {
        let root = |time_s: f64| (DVec2::new(-1.2 * ramp_integral(4.2 - time_s, [1.0, 1.9]), 0.3), 0.0);
        let mids_s = [&[0.25, 1.35, 2.45, 3.7][..], &[-0.3, 0.8, 1.9, 4.0][..]];
        let db = check(ActionKind::Stop, steps("halt", 4.2, root, mids_s), root);
        let [from_mps, to_mps] = speeds_mps(&db);
        assert!((from_mps - 1.2).abs() < 0.02 && to_mps == 0.0, "{from_mps}, {to_mps}");
    }

    #[test]
    fn turns_on_the_spot_are_found() {
        for turned_rad in [FRAC_PI_2, -PI] {
            let root = |time_s: f64| (DVec2::new(0.1, 0.2), 0.5 + turned_rad * ramp(time_s, [0.6, 2.2]));
            let mids_s = [&[0.3, 1.4, 2.6][..], &[0.6, 1.8][..]];
            let db = check(ActionKind::Turn, steps("turn", 3.0, root, mids_s), root);
            let found = &db.sources.iter().find(|source| source.file == "turn.bvh").unwrap().diagnostics;
            assert!(matches!(found[..], [Diagnostic::Note(Note::OnlyTransitionsUsed { .. })]), "{found:?}");
        }
    }

    #[test]
    fn single_steps_are_found() {
        for way_m in [DVec2::new(0.5, 0.0), DVec2::new(-0.35, 0.0), DVec2::new(0.0, -0.3)] {
            let root = |time_s: f64| (way_m * ramp(time_s, [0.7, 1.9]), 0.0);
            check(ActionKind::Step, steps("step", 2.6, root, [&[0.8, 2.1], &[0.3, 1.7]]), root);
        }
    }

    #[test]
    fn a_corner_is_a_pivot() {
        let straight =
            |start_m, facing_rad| RootArc { start_m, facing_rad, rates: Rates { speed_mps: 1.2, ..Rates::default() } };
        let turning = RootArc {
            rates: Rates { speed_mps: 0.8, turn_rate_rad_s: FRAC_PI_2 / 1.1, strafe_mps: 0.0 },
            ..straight(DVec2::new(1.2 * 2.2, 0.0), 0.0)
        };
        let (corner_m, corner_rad) = turning.at(1.1);
        let root = |time_s: f64| match time_s {
            _ if time_s < 2.2 => straight(DVec2::ZERO, 0.0).at(time_s),
            _ if time_s < 3.3 => turning.at(time_s - 2.2),
            _ => straight(corner_m, corner_rad).at(time_s - 3.3),
        };
        let mids_s: [Vec<f64>; 2] =
            [0.3, -0.25].map(|first_s| (0..7).map(|stride| first_s + 1.1 * f64::from(stride)).collect());
        let db = check(ActionKind::Pivot, steps("corner", 5.5, root, [&mids_s[0], &mids_s[1]]), root);
        for speed_mps in speeds_mps(&db) {
            assert!((speed_mps - 1.2).abs() < 0.06, "{speed_mps}");
        }
    }

    #[test]
    fn steady_gaits_and_weight_shifts_are_no_transitions() {
        let aside = |time_s: f64| (DVec2::new(0.0, 0.05 * ramp(time_s, [1.0, 1.5])), 0.0);
        let shifts = steps("shifts", 4.0, aside, [&[1.25], &[1.25]]);
        let side = SyntheticWalk { duration_s: 2.2, ..SyntheticWalk::at(0.0, 0.0, 0.15) };
        let turn = SyntheticWalk { duration_s: 6.6, ..SyntheticWalk::at(0.6, 1.5, 0.0) };
        for clip in [shifts, walk("side", side), walk("turn", turn)] {
            let db = set(clip);
            assert!(recorded(&db).is_empty(), "{:?}", recorded(&db).iter().map(|a| &a.name).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_stated_start_may_be_unlike_the_examples() {
        let root = |time_s: f64| (DVec2::new(1.2 * ramp_integral(time_s, [1.0, 1.9]), 0.3), 0.0);
        let mut go = steps("go", 4.2, root, [&[0.5, 1.75, 2.85, 3.95], &[0.2, 2.3, 3.4, 4.5]]);
        // Its arms are raised.
        for pose in &mut go.frames {
            for arm in Joint::UPPER_ARMS {
                pose.rotations[arm.index()] = DQuat::from_rotation_y(-3.0) * pose.rotations[arm.index()];
            }
        }
        assert_eq!(recorded(&set(go.clone())).len(), 0);
        go.choices.transition = Some(ActionKind::Start);
        let db = set(go.clone());
        assert_eq!(recorded(&db).iter().map(|action| action.kind).collect::<Vec<_>>(), [ActionKind::Start]);
        assert!(!db.examples.iter().any(|example| example.name == "go"));
        go.choices.transition = Some(ActionKind::Stop);
        let clips = vec![walk("walk", SyntheticWalk::default()), idle("idle", 3.0), go];
        let error = compile(clips, &Options::default(), &|_| ()).unwrap_err();
        assert!(matches!(error, CompileError::NoTransition { kind: ActionKind::Stop, .. }), "{error}");
    }

    #[test]
    fn a_set_without_a_standing_example_has_no_starts() {
        let root = |time_s: f64| (DVec2::new(1.2 * ramp_integral(time_s, [0.4, 1.3]), 0.3), 0.0);
        let go = steps("go", 3.6, root, [&[0.0, 1.15, 2.25, 3.35], &[-0.3, 1.7, 2.8, 3.9]]);
        let db = database_of(vec![walk("walk", SyntheticWalk::default()), go], 0);
        assert!(db.actions.is_empty(), "{:?}", db.actions.iter().map(|action| &action.name).collect::<Vec<_>>());
    }
}

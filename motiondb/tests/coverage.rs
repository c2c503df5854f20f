//! Coverage gaps of sets that are written by hand.

mod support;

use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::coverage::{CoverageGap, GapKind, coverage};

/// A set of examples at (v_f, ω_t, ω_s): the first is m_sp, those at rest stand. `simplices` cover the hull.
fn set(points: &[[f32; 3]], dimension: u32, simplices: &[u32]) -> MotionDb {
    let mut db = support::small_db();
    let model = db.examples[1].clone();
    let example = |&[speed_mps, turn_rate_rad_s, strafe_mps]: &[f32; 3]| {
        let mut example = model.clone();
        example.parameters = Parameters { speed_mps, turn_rate_rad_s, strafe_mps };
        example.key_times_s = if example.parameters == Parameters::default() { None } else { model.key_times_s };
        example
    };
    db.examples = points.iter().map(example).collect();
    let range = |axis: usize| {
        let [low, high] = points.iter().fold([0.0_f32; 2], |[low, high], at| [low.min(at[axis]), high.max(at[axis])]);
        high - low
    };
    db.blend_space.dimension = dimension;
    db.blend_space.axis_ranges = [range(0), range(1), range(2)];
    db.blend_space.simplices = simplices.to_vec();
    db.correspondence.as_mut().unwrap().semi_procedural = 0;
    db
}

#[track_caller]
fn check(db: &MotionDb, expected: &[(GapKind, &str)]) {
    let found = coverage(db);
    let found: Vec<(GapKind, &str)> = found.iter().map(|gap| (gap.kind, gap.sentence.as_str())).collect();
    assert_eq!(found, expected);
}

/// Sentences of the gaps of one kind.
fn sentences(gaps: &[CoverageGap], kind: GapKind) -> Vec<&str> {
    gaps.iter().filter(|gap| gap.kind == kind).map(|gap| gap.sentence.as_str()).collect()
}

#[test]
fn a_single_walk_has_every_gap_but_walking() {
    check(
        &set(&[[1.2, 0.0, 0.0]], 0, &[0]),
        &[
            (GapKind::Standing, "No clip stands: bodies stand as in the middle of their slowest steps."),
            (GapKind::Running, "No clip runs straight on: the fastest reaches 1.20 m/s."),
            (GapKind::Backward, "No clip walks straight back: bodies deform a walk for it."),
            (GapKind::WalkingTurns, "At walking speed (1.20 m/s) bodies cannot turn to either side."),
            (GapKind::TurningInPlace, "No clip turns in place to either side: bodies deform a walk for it."),
            (GapKind::SideSteps, "No clip side-steps to either side: bodies deform a walk for them."),
        ],
    );
}

#[test]
fn a_run_a_few_degrees_aside_runs_straight_on() {
    let gaps = |aside_mps: f32| coverage(&set(&[[1.2, 0.0, 0.0], [4.0, 0.0, aside_mps]], 0, &[0]));
    assert_eq!(sentences(&gaps(0.28), GapKind::Running), [""; 0]);
    assert_eq!(sentences(&gaps(0.6), GapKind::Running).len(), 1);
}

#[test]
fn steps_aside_and_in_place_do_not_walk_ahead() {
    let walk = "No clip walks forward: bodies reach no goal, and no walk can be deformed.";
    let gaps = coverage(&set(&[[0.04, 0.0, 0.6], [0.02, 1.2, 0.0]], 0, &[0]));
    assert_eq!(sentences(&gaps, GapKind::Walking), [walk]);
}

#[test]
fn wide_turns_and_gaps_are_measured() {
    // At 1.2 m/s the hull ends between the turn at 0.8 and the run at 2.2 m/s: 0.45 rad/s · 1.0 / 1.4.
    let points = [[1.2, 0.0, 0.0], [0.0, 0.0, 0.0], [0.8, 0.45, 0.0], [0.8, -0.45, 0.0], [2.2, 0.0, 0.0]];
    let found = coverage(&set(&points, 2, &[1, 2, 4, 1, 3, 4]));
    assert_eq!(
        sentences(&found, GapKind::WalkingTurns),
        ["At walking speed (1.20 m/s) the fastest turn to either side is 18 °/s: it needs a radius of 3.7 m."]
    );
    assert_eq!(
        sentences(&found, GapKind::SpeedGap),
        [
            "Straight on, no clip lies between 0.00 and 1.20 m/s: speeds between blend the two.",
            "Straight on, no clip lies between 1.20 and 2.20 m/s: speeds between blend the two.",
        ]
    );
    let filled = [GapKind::Standing, GapKind::Walking, GapKind::Running];
    assert!(filled.into_iter().all(|kind| sentences(&found, kind).is_empty()), "{found:?}");
}

#[test]
fn a_turn_that_drifts_aside_is_a_turn() {
    // The fastest of the set is m_sp, and drifts by 0.05 m/s to the side on which it does not turn faster.
    let found = coverage(&set(&[[1.6, 0.25, 0.05], [1.6, 1.2, 0.0], [1.6, -1.2, -0.1]], 0, &[0]));
    assert_eq!(sentences(&found, GapKind::WalkingTurns), [""; 0]);
    let orbits = coverage(&set(&[[1.6, 0.25, 0.05], [1.6, 1.2, 0.9], [1.6, -1.2, -0.9]], 0, &[0]));
    assert_eq!(sentences(&orbits, GapKind::WalkingTurns).len(), 2);
}

#[test]
fn a_gap_of_one_side_names_that_side() {
    // A pyramid: it turns tightly, spins and side-steps to the left, and does none of these to the right.
    let points = [[1.2, 0.0, 0.0], [0.0, 2.0, 0.0], [2.2, 2.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0], [2.2, 0.0, 0.0]];
    let found = coverage(&set(&points, 3, &[3, 4, 1, 5, 3, 1, 2, 5]));
    let check_only = |kind: GapKind, sentence: &str| assert_eq!(sentences(&found, kind), [sentence]);
    check_only(GapKind::WalkingTurns, "At walking speed (1.20 m/s) bodies cannot turn to the right.");
    check_only(GapKind::TurningInPlace, "No clip turns in place to the right.");
    check_only(GapKind::SideSteps, "No clip side-steps to the right.");
}

#[test]
fn a_dense_set_has_no_gap() {
    let mut points = vec![[1.2, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.7, 0.0, 0.0], [1.9, 0.0, 0.0], [2.4, 0.0, 0.0]];
    points.push([0.6, 0.0, 0.0]);
    for side in [1.0, -1.0] {
        points.extend([[0.0, side, 0.0], [0.0, 2.0 * side, 0.0], [2.4, 2.0 * side, 0.0], [0.0, 0.0, 0.5 * side]]);
    }
    // The simplices lie in the plane ω_s = 0; side-steps need none.
    check(&set(&points, 2, &[7, 8, 11, 8, 11, 12]), &[]);
}

#[test]
fn turns_of_both_sides_make_one_gap() {
    let points = [[1.2, 0.0, 0.0], [1.2, 1.5, 0.0], [1.2, -1.5, 0.0], [1.2, 0.0, 0.9], [1.2, 0.0, -0.9]];
    let found = coverage(&set(&points, 2, &[1, 3, 2, 1, 2, 4]));
    assert_eq!(
        sentences(&found, GapKind::TurnGap),
        ["No clip turns at rates between 0 and 86 °/s: turns between blend the two."]
    );
    assert_eq!(
        sentences(&found, GapKind::SideGap),
        ["No clip side-steps at speeds between 0.00 and 0.90 m/s: steps between blend the two."]
    );
}

#[test]
fn a_walk_backward_alone_reaches_no_goal() {
    let found = coverage(&set(&[[-0.6, 0.0, 0.0]], 0, &[0]));
    assert_eq!(
        sentences(&found, GapKind::Walking),
        ["No clip walks forward: bodies reach no goal, and no walk can be deformed."]
    );
    assert_eq!(sentences(&found, GapKind::SideSteps), ["No clip side-steps to either side."]);
}

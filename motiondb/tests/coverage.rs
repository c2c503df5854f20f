//! Thin places of sets written down by hand.

mod support;

use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::coverage::{Lack, coverage};

/// Examples at (v_f, ω_t, ω_s), the first m_sp; those at rest stand. `simplices` cover the hull of the points.
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
fn check(db: &MotionDb, wanted: &[(Lack, &str)]) {
    let found = coverage(db);
    let found: Vec<(Lack, &str)> = found.iter().map(|thin| (thin.lack, thin.sentence.as_str())).collect();
    assert_eq!(found, wanted);
}

#[test]
fn a_single_walk_lacks_all_but_walking() {
    check(
        &set(&[[1.2, 0.0, 0.0]], 0, &[0]),
        &[
            (Lack::Standing, "No clip stands: bodies stand as in the middle of their slowest steps."),
            (Lack::Running, "No clip runs straight on: the fastest makes 1.20 m/s."),
            (Lack::Backward, "No clip walks straight back: bodies cannot step back."),
            (Lack::WalkingTurns, "At walking speed (1.20 m/s) nothing turns to either side."),
            (Lack::TurningInPlace, "No clip turns in place to either side: bodies deform a walk for it."),
            (Lack::SideSteps, "No clip side-steps to either side: bodies deform a walk for them."),
        ],
    );
}

#[test]
fn wide_turns_and_gaps_are_measured() {
    // At 1.2 m/s the hull ends between the turn at 0.8 and the run at 2.2 m/s: 0.45 rad/s · 1.0 / 1.4.
    let points = [[1.2, 0.0, 0.0], [0.0, 0.0, 0.0], [0.8, 0.45, 0.0], [0.8, -0.45, 0.0], [2.2, 0.0, 0.0]];
    let found = coverage(&set(&points, 2, &[1, 2, 4, 1, 3, 4]));
    let sentence = |lack: Lack| found.iter().filter(move |thin| thin.lack == lack).map(|thin| thin.sentence.as_str());
    assert!(
        sentence(Lack::WalkingTurns)
            .eq(["At walking speed (1.20 m/s) the fastest turn to either side is 18 °/s: it needs a radius of 3.7 m."])
    );
    assert!(sentence(Lack::SpeedGap).eq([
        "Straight on, no clip lies between 0.00 and 1.20 m/s: speeds between mix the two.",
        "Straight on, no clip lies between 1.20 and 2.20 m/s: speeds between mix the two.",
    ]));
    assert!([Lack::Standing, Lack::Walking, Lack::Running].iter().all(|lack| sentence(*lack).next().is_none()));
}

#[test]
fn what_one_side_lacks_is_said_of_that_side() {
    // A pyramid: to the left it turns tightly, spins and side-steps; to the right it does nothing.
    let points = [[1.2, 0.0, 0.0], [0.0, 2.0, 0.0], [2.2, 2.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0], [2.2, 0.0, 0.0]];
    let found = coverage(&set(&points, 3, &[3, 4, 1, 5, 3, 1, 2, 5]));
    let of = |lack: Lack| {
        found.iter().filter(|thin| thin.lack == lack).map(|thin| thin.sentence.clone()).collect::<Vec<_>>()
    };
    let one = |lack: Lack, sentence: &str| assert_eq!(of(lack), [sentence]);
    one(Lack::WalkingTurns, "At walking speed (1.20 m/s) nothing turns to the right.");
    one(Lack::TurningInPlace, "No clip turns in place to the right.");
    one(Lack::SideSteps, "No clip side-steps to the right.");
}

#[test]
fn a_dense_set_has_no_thin_place() {
    let mut points = vec![[1.2, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.7, 0.0, 0.0], [1.9, 0.0, 0.0], [2.4, 0.0, 0.0]];
    points.push([0.6, 0.0, 0.0]);
    for side in [1.0, -1.0] {
        points.extend([[0.0, side, 0.0], [0.0, 2.0 * side, 0.0], [2.4, 2.0 * side, 0.0], [0.0, 0.0, 0.5 * side]]);
    }
    // In the plane ω_s = 0; the side-steps need no simplex to be there.
    check(&set(&points, 2, &[7, 8, 11, 8, 11, 12]), &[]);
}

#[test]
fn gaps_between_turns_and_side_speeds_are_said_once_for_both_sides() {
    let points = [[1.2, 0.0, 0.0], [1.2, 1.5, 0.0], [1.2, -1.5, 0.0], [1.2, 0.0, 0.9], [1.2, 0.0, -0.9]];
    let found = coverage(&set(&points, 2, &[1, 3, 2, 1, 2, 4]));
    let sentence = |lack: Lack| found.iter().filter(move |thin| thin.lack == lack).map(|thin| thin.sentence.as_str());
    assert!(
        sentence(Lack::TurnGap).eq(["No clip turns at rates between 0 and 86 °/s: turns between mix the two."]),
        "{found:?}"
    );
    let side_gap = "No clip goes aside at speeds between 0.00 and 0.90 m/s: steps between mix the two.";
    assert!(sentence(Lack::SideGap).eq([side_gap]), "{found:?}");
}

#[test]
fn a_walk_backward_alone_reaches_no_goal() {
    let found = coverage(&set(&[[-0.6, 0.0, 0.0]], 0, &[0]));
    let sentence = |lack: Lack| found.iter().find(|thin| thin.lack == lack).map(|thin| thin.sentence.as_str());
    assert_eq!(
        sentence(Lack::Walking),
        Some("No clip walks ahead: bodies reach no goal, and no walk can be deformed.")
    );
    assert_eq!(sentence(Lack::SideSteps), Some("No clip side-steps to either side."));
}

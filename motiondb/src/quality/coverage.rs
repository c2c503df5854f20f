//! Coverage gaps: regions of (v_f, ω_t, ω_s) without examples, each with a sentence for people. There bodies cannot
//! move, or only by a blend of motions that differ much.
//!
//! Two sources: the examples (does one stand, step back, turn in place, side-step; how far apart are neighbours along
//! one axis?) and the hull of their parameters (how fast can a body turn while it walks?). Speeds in m/s, turn rates in
//! rad/s (in sentences °/s), left positive.

use serde::Serialize;

use crate::body::skeleton::Side;
use crate::motion::motion_db::MotionDb;
use crate::motion::parameters::Parameters;
use crate::velocity_sets::velocity_hull::{faces_its_way, goes_straight, is_holding};

/// Least speed of a motion that leaves its position, m/s; the compiler mirrors examples from this side speed on.
const MOVES_MPS: f32 = 0.15;
/// Greatest drift of a turn in place, m/s: that of the Marine clips drifts at 0.19.
const IN_PLACE_MPS: f32 = 0.25;
/// Least rate of a turn in place, rad/s: 30 °/s, half a turn in six seconds.
const IN_PLACE_TURN_RAD_S: f32 = 30.0 * std::f32::consts::PI / 180.0;
/// Speed from which people run rather than walk, m/s (Hreljac 1993: 2.05 ± 0.1).
pub const RUN_MPS: f32 = 2.05;
/// Greatest radius of a walking turn that fits into a corridor, m.
const TURN_RADIUS_MAX_M: f32 = 1.5;
/// Greatest difference of neighbouring speeds whose gaits are alike, m/s: slow walk to fast walk.
const SPEED_GAP_MPS: f32 = 0.75;
/// Greatest difference of neighbouring turn rates whose gaits are alike, rad/s: 60 °/s, straight on to a tight bend.
const TURN_GAP_RAD_S: f32 = 60.0 * std::f32::consts::PI / 180.0;
/// Least turn rate that is a turn, rad/s: 3 °/s; below is gait noise.
const TURNS_RAD_S: f32 = 3.0 * std::f32::consts::PI / 180.0;

/// Kinds of coverage gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GapKind {
    /// No example stands.
    Standing,
    /// No straight example walks.
    Walking,
    /// No straight example runs.
    Running,
    /// No straight example goes backward.
    Backward,
    /// Turns at walking speed are wide, or there are none.
    WalkingTurns,
    /// No example turns in place, to one side or both.
    TurningInPlace,
    /// No example side-steps, to one side or both.
    SideSteps,
    /// Neighbouring speeds of straight examples are far apart.
    SpeedGap,
    /// Neighbouring turn rates are far apart.
    TurnGap,
    /// Neighbouring side speeds are far apart.
    SideGap,
}

/// A region of parameters without examples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CoverageGap {
    /// Kind of the gap; `lack` in JSON.
    #[serde(rename = "lack")]
    pub kind: GapKind,
    /// The gap and its consequence, with numbers, as a sentence for people.
    pub sentence: String,
}

/// Every coverage gap of a database, in the order of [`GapKind`].
pub fn coverage(db: &MotionDb) -> Vec<CoverageGap> {
    let gaps_by_kind = [
        gait_gaps(db),
        walking_turn_gaps(db),
        side_gaps(db, GapKind::TurningInPlace, turns_in_place, "turns in place", "it"),
        side_gaps(db, GapKind::SideSteps, side_steps, "side-steps", "them"),
        speed_gaps(db),
        turn_rate_gaps(db),
        side_speed_gaps(db),
    ];
    gaps_by_kind.concat()
}

/// Whether an example walks forward by more than side-steps and turns in place drift: without one, bodies reach no goal.
pub fn walks_ahead(db: &MotionDb) -> bool {
    db.examples.iter().any(|example| example.key_times_s.is_some() && example.parameters.speed_mps >= MOVES_MPS)
}

/// Speeds of the examples that go straight on or back, m/s.
fn straight_speeds_mps(db: &MotionDb) -> impl Iterator<Item = f32> {
    db.parameters().filter(goes_straight).map(|found| found.speed_mps)
}

/// Gaps of standing, walking, running and stepping back.
fn gait_gaps(db: &MotionDb) -> Vec<CoverageGap> {
    let stands = db.examples.iter().any(|example| example.key_times_s.is_none());
    let fastest_mps = straight_speeds_mps(db).fold(0.0, f32::max);
    let no_run = match fastest_mps > 0.0 {
        true => format!("No clip runs straight on: the fastest reaches {fastest_mps:.2} m/s."),
        false => "No clip runs straight on.".to_owned(),
    };
    let no_walk = match walks_ahead(db) {
        true => "No clip walks straight on.",
        false => "No clip walks forward: bodies reach no goal, and no walk can be deformed.",
    };
    let no_step_back = match walks_ahead(db) {
        true => "No clip walks straight back: bodies deform a walk for it.",
        false => "No clip walks straight back.",
    };
    let walks = straight_speeds_mps(db).any(|speed| (MOVES_MPS..RUN_MPS).contains(&speed));
    let steps_back = straight_speeds_mps(db).any(|speed| speed < -MOVES_MPS);
    let gaits = [
        (stands, GapKind::Standing, "No clip stands: bodies stand as in the middle of their slowest steps.".to_owned()),
        (walks, GapKind::Walking, no_walk.to_owned()),
        (fastest_mps >= RUN_MPS, GapKind::Running, no_run),
        (steps_back, GapKind::Backward, no_step_back.to_owned()),
    ];
    let missing = gaits.into_iter().filter(|(present, ..)| !present);
    missing.map(|(_, kind, sentence)| CoverageGap { kind, sentence }).collect()
}

/// Gaps of turns at the speed of m_sp, or of the first example that steps: sides on which they are wide.
fn walking_turn_gaps(db: &MotionDb) -> Vec<CoverageGap> {
    let m_sp = db.correspondence.as_ref().map(|found| found.semi_procedural as usize);
    let Some(walk) = m_sp.or_else(|| db.examples.iter().position(|example| example.key_times_s.is_some())) else {
        return Vec::new();
    };
    let walk_mps = db.examples[walk].parameters.speed_mps;
    let [left, right] = Side::BOTH.map(|side| fastest_turn_rad_s(db, walk_mps, side));
    let are_alike = (left - right).abs() <= 0.1 * left.max(right);
    let sides =
        if are_alike { vec![(left.min(right), "either side")] } else { vec![(left, "the left"), (right, "the right")] };
    let is_wide = |rate_rad_s: f32| rate_rad_s * TURN_RADIUS_MAX_M < walk_mps.abs();
    let gap = |(rate_rad_s, side): (f32, &str)| CoverageGap {
        kind: GapKind::WalkingTurns,
        sentence: walking_turn_sentence(walk_mps, rate_rad_s, side),
    };
    sides.into_iter().filter(|(rate, _)| is_wide(*rate)).map(gap).collect()
}

fn walking_turn_sentence(speed_mps: f32, rate_rad_s: f32, side: &str) -> String {
    let at = format!("At walking speed ({speed_mps:.2} m/s)");
    if rate_rad_s < TURNS_RAD_S {
        return format!("{at} bodies cannot turn to {side}.");
    }
    let (rate_deg_s, radius_m) = (rate_rad_s.to_degrees(), speed_mps.abs() / rate_rad_s);
    format!("{at} the fastest turn to {side} is {rate_deg_s:.0} °/s: it needs a radius of {radius_m:.1} m.")
}

/// Greatest turn rate to one side at a speed, rad/s, of blends of examples that face their way. It lies on an edge of
/// the hull of their (v_f, ω_t): between an example of at most this speed and one of at least this speed.
fn fastest_turn_rad_s(db: &MotionDb, speed_mps: f32, side: Side) -> f32 {
    let ahead: Vec<Parameters> = db.parameters().filter(faces_its_way).collect();
    let slower = ahead.iter().filter(|found| found.speed_mps <= speed_mps);
    let faster = || ahead.iter().filter(|found| found.speed_mps >= speed_mps);
    let between = |slow: &Parameters, fast: &Parameters| {
        let share = (speed_mps - slow.speed_mps) / (fast.speed_mps - slow.speed_mps).max(f32::MIN_POSITIVE);
        side.sign() * (slow.turn_rate_rad_s + share * (fast.turn_rate_rad_s - slow.turn_rate_rad_s))
    };
    slower.flat_map(|slow| faster().map(|fast| between(slow, fast))).fold(0.0, f32::max)
}

fn turns_in_place(found: &Parameters, side: Side) -> bool {
    found.speed_mps.abs() <= IN_PLACE_MPS
        && found.strafe_mps.abs() <= IN_PLACE_MPS
        && side.sign() * found.turn_rate_rad_s >= IN_PLACE_TURN_RAD_S
}

/// Whether a motion at held facing goes more to the side than forward or back.
fn side_steps(found: &Parameters, side: Side) -> bool {
    let aside_mps = side.sign() * found.strafe_mps;
    is_holding(found) && aside_mps >= MOVES_MPS && aside_mps >= found.speed_mps.abs()
}

/// A gap if no example performs a motion to one side or both. `verb` and `object` name the motion in the sentence.
fn side_gaps(
    db: &MotionDb,
    kind: GapKind,
    performs: fn(&Parameters, Side) -> bool,
    verb: &str,
    object: &str,
) -> Vec<CoverageGap> {
    let present = Side::BOTH.map(|side| db.parameters().any(|found| performs(&found, side)));
    let sentence = match present {
        [true, true] => return Vec::new(),
        [false, false] if walks_ahead(db) => {
            format!("No clip {verb} to either side: bodies deform a walk for {object}.")
        }
        [false, false] => format!("No clip {verb} to either side."),
        [false, true] => format!("No clip {verb} to the left."),
        [true, false] => format!("No clip {verb} to the right."),
    };
    vec![CoverageGap { kind, sentence }]
}

fn speed_gaps(db: &MotionDb) -> Vec<CoverageGap> {
    let sentence = |[low, high]: [f32; 2]| {
        format!("Straight on, no clip lies between {low:.2} and {high:.2} m/s: speeds between blend the two.")
    };
    neighbour_gaps(straight_speeds_mps(db), SPEED_GAP_MPS, GapKind::SpeedGap, sentence)
}

/// Both sides count as one, since sets are mirrored.
fn turn_rate_gaps(db: &MotionDb) -> Vec<CoverageGap> {
    let sentence = |ends: [f32; 2]| {
        let [low, high] = ends.map(f32::to_degrees);
        format!("No clip turns at rates between {low:.0} and {high:.0} °/s: turns between blend the two.")
    };
    let rates_rad_s = db.parameters().map(|found| found.turn_rate_rad_s.abs());
    neighbour_gaps(rates_rad_s, TURN_GAP_RAD_S, GapKind::TurnGap, sentence)
}

/// Both sides count as one, since sets are mirrored.
fn side_speed_gaps(db: &MotionDb) -> Vec<CoverageGap> {
    let sentence = |[low, high]: [f32; 2]| {
        format!("No clip side-steps at speeds between {low:.2} and {high:.2} m/s: steps between blend the two.")
    };
    let speeds_mps = db.parameters().map(|found| found.strafe_mps.abs());
    neighbour_gaps(speeds_mps, SPEED_GAP_MPS, GapKind::SideGap, sentence)
}

/// A gap for each pair of neighbouring values that differ by more than the limit.
fn neighbour_gaps(
    values: impl Iterator<Item = f32>,
    limit: f32,
    kind: GapKind,
    sentence: impl Fn([f32; 2]) -> String,
) -> Vec<CoverageGap> {
    let mut values: Vec<f32> = values.collect();
    values.sort_by(f32::total_cmp);
    let wide = values.windows(2).filter(|pair| pair[1] - pair[0] > limit);
    wide.map(|pair| CoverageGap { kind, sentence: sentence([pair[0], pair[1]]) }).collect()
}

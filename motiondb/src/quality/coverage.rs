//! Where in (v_f, ω_t, ω_s) a set of clips is thin, in words: what bodies that move by it cannot do, or do only by
//! mixing motions that differ much.
//!
//! Two sources: the examples themselves (does any stand, step back, turn in place, side-step; how far apart are
//! neighbours along one axis) and the hull of their parameters (how fast a body can turn while it walks). Speeds in
//! m/s, turn rates in rad/s; in sentences °/s. Left is positive.

use glam::Vec3;
use serde::Serialize;

use crate::blend_space::lattice::{FLAT_SHARE, LEAST_RANGES};
use crate::blend_space::locator::Locator;
use crate::blend_space::space::{BlendSpace, Shares};
use crate::body::skeleton::Side;
use crate::motion::motion_db::MotionDb;
use crate::motion::parameters::Parameters;
use crate::velocity_sets::velocity_hull::{TURNING_STRAFE_MAX_MPS, is_holding};

/// Slower than this a body all but stays: where an example counts as mirrored for its side speed, too, m/s.
const MOVES_MPS: f32 = 0.15;
/// A turn in place may drift this fast (Marine's drifts at 0.19), m/s.
const IN_PLACE_MPS: f32 = 0.25;
/// A turn in place takes less than six seconds for half a turn: 30 °/s.
const IN_PLACE_TURN_RAD_S: f32 = 30.0 * std::f32::consts::PI / 180.0;
/// People walk up to here, and run from here on (Hreljac 1993: 2.05 ± 0.1), m/s.
pub(crate) const RUN_MPS: f32 = 2.05;
/// A walking turn wider than this does not fit into a corridor, metres.
const TURN_RADIUS_MAX_M: f32 = 1.5;
/// Neighbours further apart than this mix gaits that hardly resemble each other: from slow walk to fast walk, m/s.
const SPEED_GAP_MPS: f32 = 0.75;
/// The same for turn rates: from straight on to a tight bend, 60 °/s.
const TURN_GAP_RAD_S: f32 = 60.0 * std::f32::consts::PI / 180.0;
/// A query is inside the hull where the shares reach it to this part of each axis's range.
const REACHED_SHARE: f32 = 5e-4;
/// Halvings that find the fastest turn to a millionth of the range.
const HALVINGS: u32 = 20;

/// What a set lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Lack {
    /// No example stands.
    Standing,
    /// No straight example walks.
    Walking,
    /// No example runs.
    Running,
    /// No example goes backward.
    Backward,
    /// Turns while walking are wide, or there are none.
    WalkingTurns,
    /// No example turns in place, to one side or both.
    TurningInPlace,
    /// No example side-steps, to one side or both.
    SideSteps,
    /// Neighbouring speeds straight on are far apart.
    SpeedGap,
    /// Neighbouring turn rates are far apart.
    TurnGap,
    /// Neighbouring side speeds are far apart.
    SideGap,
}

/// One thin place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThinPlace {
    /// What is lacking.
    pub lack: Lack,
    /// In a plain sentence, with numbers and consequence.
    pub sentence: String,
}

/// Every thin place of a database, in the order of [`Lack`]; none where it serves all ways of walking.
pub fn coverage(db: &MotionDb) -> Vec<ThinPlace> {
    let of_lacks = [
        gaits(db),
        walking_turns(db),
        sides(db, Lack::TurningInPlace, turns_in_place, "turns in place", "it"),
        sides(db, Lack::SideSteps, side_steps, "side-steps", "them"),
        speed_gaps(db),
        turn_gaps(db),
        side_gaps(db),
    ];
    of_lacks.concat()
}

/// Whether any example steps ahead: without one bodies reach no goal.
pub fn walks_ahead(db: &MotionDb) -> bool {
    db.examples.iter().any(|example| example.key_times_s.is_some() && example.parameters.speed_mps > 0.0)
}

/// Shares of the examples at a query inside the hull of their parameters; none outside it. `locator` is the database's.
pub fn locate_inside(db: &MotionDb, locator: &Locator, query: Parameters) -> Option<Shares> {
    let shares = locator.locate(query);
    let terms = shares.examples.into_iter().zip(shares.shares);
    let reached: Vec3 = terms.map(|(example, share)| share * db.examples[example as usize].parameters.to_vec3()).sum();
    let tolerance = reach_tolerance(&db.blend_space);
    (reached - query.to_vec3()).abs().cmple(tolerance).all().then_some(shares)
}

/// How far off the shares may be along each axis: noise along those that are dropped, and along all that a flat set
/// leans on.
fn reach_tolerance(space: &BlendSpace) -> Vec3 {
    let ranged = space.axis_ranges.iter().filter(|range| **range > 0.0).count();
    let share = if ranged == space.dimension as usize { REACHED_SHARE } else { FLAT_SHARE };
    Vec3::from_array(std::array::from_fn(|axis| match space.axis_ranges[axis] {
        0.0 => LEAST_RANGES[axis],
        range => share * range,
    }))
}

/// The database's own locator.
pub fn locator(db: &MotionDb) -> Locator {
    Locator::new(&db.blend_space, &parameters(db).collect::<Vec<_>>())
}

fn parameters(db: &MotionDb) -> impl Iterator<Item = Parameters> {
    db.examples.iter().map(|example| example.parameters)
}

/// Examples that go straight on or back.
fn straight(db: &MotionDb) -> impl Iterator<Item = f32> {
    let is_straight = |found: &Parameters| is_holding(found) && found.strafe_mps.abs() <= TURNING_STRAFE_MAX_MPS;
    parameters(db).filter(is_straight).map(|found| found.speed_mps)
}

/// Standing, walking, running, stepping back.
fn gaits(db: &MotionDb) -> Vec<ThinPlace> {
    let stands = db.examples.iter().any(|example| example.key_times_s.is_none());
    let fastest_mps = straight(db).fold(0.0, f32::max);
    let runs = match fastest_mps > 0.0 {
        true => format!("No clip runs straight on: the fastest makes {fastest_mps:.2} m/s."),
        false => "No clip runs straight on.".to_owned(),
    };
    let lacks = [
        (stands, Lack::Standing, "No clip stands: bodies stand as in the middle of their slowest steps.".to_owned()),
        (
            straight(db).any(|speed| (MOVES_MPS..RUN_MPS).contains(&speed)),
            Lack::Walking,
            match walks_ahead(db) {
                true => "No clip walks straight on.".to_owned(),
                false => "No clip walks ahead: bodies reach no goal, and no walk can be deformed.".to_owned(),
            },
        ),
        (fastest_mps >= RUN_MPS, Lack::Running, runs),
        (
            straight(db).any(|speed| speed < -MOVES_MPS),
            Lack::Backward,
            "No clip walks straight back: bodies cannot step back.".to_owned(),
        ),
    ];
    let missing = lacks.into_iter().filter(|(present, ..)| !present);
    missing.map(|(_, lack, sentence)| ThinPlace { lack, sentence }).collect()
}

/// How tightly a body turns at the speed of m_sp, or of its only walk, on its wide sides.
fn walking_turns(db: &MotionDb) -> Vec<ThinPlace> {
    let m_sp = db.correspondence.as_ref().map(|found| found.semi_procedural as usize);
    let Some(walk) = m_sp.or_else(|| db.examples.iter().position(|example| example.key_times_s.is_some())) else {
        return Vec::new();
    };
    let walk = db.examples[walk].parameters;
    let locator = locator(db);
    let fastest_rad_s = Side::BOTH.map(|side| fastest_turn_rad_s(db, &locator, walk, side));
    let is_wide = |rate_rad_s: f32| rate_rad_s * TURN_RADIUS_MAX_M < walk.speed_mps.abs();
    let sentence = |rate_rad_s: f32, side: &str| {
        let at = format!("At walking speed ({:.2} m/s)", walk.speed_mps);
        let degrees_s = rate_rad_s.to_degrees();
        match degrees_s {
            // Slower turns are a gait's noise.
            3.0.. => {
                let radius_m = walk.speed_mps.abs() / rate_rad_s;
                format!("{at} the fastest turn to {side} is {degrees_s:.0} °/s: it needs a radius of {radius_m:.1} m.")
            }
            _ => format!("{at} nothing turns to {side}."),
        }
    };
    let [left, right] = fastest_rad_s;
    let alike = (left - right).abs() <= 0.1 * left.max(right);
    let named =
        if alike { vec![(left.min(right), "either side")] } else { vec![(left, "the left"), (right, "the right")] };
    let wide = named.into_iter().filter(|(rate, _)| is_wide(*rate));
    wide.map(|(rate, side)| ThinPlace { lack: Lack::WalkingTurns, sentence: sentence(rate, side) }).collect()
}

/// The greatest turn rate to one side that the hull holds at the walk's speeds, by bisection: the hull is convex.
fn fastest_turn_rad_s(db: &MotionDb, locator: &Locator, walk: Parameters, side: Side) -> f32 {
    let turned = |rate_rad_s: f32| Parameters { turn_rate_rad_s: side.sign() * rate_rad_s, ..walk };
    let own_rad_s = side.sign() * walk.turn_rate_rad_s;
    let greatest_rad_s = parameters(db).map(|found| side.sign() * found.turn_rate_rad_s).fold(own_rad_s, f32::max);
    let (mut inside, mut outside) = (own_rad_s, greatest_rad_s);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        let end = if locate_inside(db, locator, turned(middle)).is_some() { &mut inside } else { &mut outside };
        *end = middle;
    }
    inside.max(0.0)
}

fn turns_in_place(found: &Parameters, side: Side) -> bool {
    found.speed_mps.abs() <= IN_PLACE_MPS
        && found.strafe_mps.abs() <= IN_PLACE_MPS
        && side.sign() * found.turn_rate_rad_s >= IN_PLACE_TURN_RAD_S
}

/// More aside than ahead, at held facing.
fn side_steps(found: &Parameters, side: Side) -> bool {
    let aside_mps = side.sign() * found.strafe_mps;
    is_holding(found) && aside_mps >= MOVES_MPS && aside_mps >= found.speed_mps.abs()
}

/// That no example does something to one side or both.
fn sides(db: &MotionDb, lack: Lack, does: fn(&Parameters, Side) -> bool, deed: &str, deeds: &str) -> Vec<ThinPlace> {
    let done = Side::BOTH.map(|side| parameters(db).any(|found| does(&found, side)));
    let sentence = match done {
        [true, true] => return Vec::new(),
        [false, false] if walks_ahead(db) => {
            format!("No clip {deed} to either side: bodies deform a walk for {deeds}.")
        }
        [false, false] => format!("No clip {deed} to either side."),
        [false, true] => format!("No clip {deed} to the left."),
        [true, false] => format!("No clip {deed} to the right."),
    };
    vec![ThinPlace { lack, sentence }]
}

fn speed_gaps(db: &MotionDb) -> Vec<ThinPlace> {
    let sentence = |[low, high]: [f32; 2]| {
        format!("Straight on, no clip lies between {low:.2} and {high:.2} m/s: speeds between mix the two.")
    };
    gaps(straight(db).collect(), SPEED_GAP_MPS, Lack::SpeedGap, sentence)
}

/// Turns of both sides count as one: sets are mirrored.
fn turn_gaps(db: &MotionDb) -> Vec<ThinPlace> {
    let sentence = |ends: [f32; 2]| {
        let [low, high] = ends.map(f32::to_degrees);
        format!("No clip turns at rates between {low:.0} and {high:.0} °/s: turns between mix the two.")
    };
    gaps(parameters(db).map(|found| found.turn_rate_rad_s.abs()).collect(), TURN_GAP_RAD_S, Lack::TurnGap, sentence)
}

fn side_gaps(db: &MotionDb) -> Vec<ThinPlace> {
    let sentence = |[low, high]: [f32; 2]| {
        format!("No clip goes aside at speeds between {low:.2} and {high:.2} m/s: steps between mix the two.")
    };
    gaps(parameters(db).map(|found| found.strafe_mps.abs()).collect(), SPEED_GAP_MPS, Lack::SideGap, sentence)
}

/// Neighbours among values that stand further apart than the limit.
fn gaps(mut values: Vec<f32>, limit: f32, lack: Lack, sentence: impl Fn([f32; 2]) -> String) -> Vec<ThinPlace> {
    values.sort_by(f32::total_cmp);
    let wide = values.windows(2).filter(|pair| pair[1] - pair[0] > limit);
    wide.map(|pair| ThinPlace { lack, sentence: sentence([pair[0], pair[1]]) }).collect()
}

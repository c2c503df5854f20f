//! Every invariant of a database, by name. The runtime relies on all of them, so [`crate::file::load`] refuses what
//! breaks one.
//!
//! Structure comes first: the later checks index where those have looked, and are left out where one of those is broken.

use std::f32::consts::PI;

use glam::Vec2;

use crate::motion_db::{MotionDb, MotionExample, PHASE_COUNT};
use crate::phase_map::MAX_ASYMMETRY;
use crate::skeleton::{JOINT_COUNT, Joint};
use crate::velocity_hull::{is_holding, is_turning, turning_point_mps};

/// A rotation's length may be off 1 by rounding.
const UNIT_TOLERANCE: f32 = 1e-3;
/// Corners may stray this far outside a hull by rounding, m/s.
const HULL_TOLERANCE_MPS: f32 = 1e-3;
/// No human motion is faster; beyond lies a unit error.
const SPEED_LIMIT_MPS: f32 = 15.0;
/// Nor turns faster: two turns a second.
const TURN_LIMIT_RAD_S: f32 = 4.0 * PI;
/// A seam between the last row and the first this many times the cycle's own greatest step is a jump.
const SEAM_LIMIT: f32 = 2.0;
/// Simplices must cover the hull but for rounding.
const COVERED_TOLERANCE: f32 = 1e-3;

/// One invariant and how it fares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Stable name.
    pub name: &'static str,
    /// Where and how it is broken; none where it holds.
    pub broken: Option<String>,
}

type Outcome = Result<(), String>;

type Invariant = (&'static str, fn(&MotionDb) -> Outcome);

/// What all else relies on, in order of dependence; the doc of each function is the invariant.
const STRUCTURE: [Invariant; 4] = [
    ("has_examples", has_examples),
    ("skeleton_is_a_body", skeleton_is_a_body),
    ("rows_are_complete", rows_are_complete),
    ("indices_are_in_range", indices_are_in_range),
];

/// What may hold or break by itself.
const CONTENT: [Invariant; 12] = [
    ("names_are_unique", names_are_unique),
    ("parameters_are_human", parameters_are_human),
    ("phase_maps_rise", phase_maps_rise),
    ("key_times_lie_in_the_cycle", key_times_lie_in_the_cycle),
    ("rows_are_finite", rows_are_finite),
    ("rotations_are_unit_and_aligned", rotations_are_unit_and_aligned),
    ("cycles_close", cycles_close),
    ("hulls_are_clockwise_and_convex", hulls_are_clockwise_and_convex),
    ("hulls_hold_their_examples", hulls_hold_their_examples),
    ("sharp_turn_edges_hold_the_origin", sharp_turn_edges_hold_the_origin),
    ("simplices_cover_the_examples", simplices_cover_the_examples),
    ("correspondences_are_cyclic", correspondences_are_cyclic),
];

/// All invariants; where the structure is broken, only those up to its first fault.
pub fn validate(db: &MotionDb) -> Vec<Check> {
    let check = |(name, invariant): Invariant| Check { name, broken: invariant(db).err() };
    let mut checks = Vec::new();
    for invariant in STRUCTURE {
        checks.push(check(invariant));
        if checks.last().is_some_and(|check| check.broken.is_some()) {
            return checks;
        }
    }
    checks.extend(CONTENT.map(check));
    checks
}

fn ensure(holds: bool, detail: impl FnOnce() -> String) -> Outcome {
    if holds { Ok(()) } else { Err(detail()) }
}

fn each(db: &MotionDb, check: impl Fn(&MotionExample) -> Outcome) -> Outcome {
    db.examples.iter().try_for_each(|example| check(example).map_err(|detail| format!("{}: {detail}", example.name)))
}

/// There is at least one example.
fn has_examples(db: &MotionDb) -> Outcome {
    ensure(!db.examples.is_empty(), || "the database holds no example".into())
}

/// Bones are finite, legs have length, radii are positive, limits are ordered.
fn skeleton_is_a_body(db: &MotionDb) -> Outcome {
    let skeleton = &db.skeleton;
    for joint in Joint::ALL {
        let index = joint.index();
        let [least, greatest] = skeleton.limits_rad[index];
        let vectors = [skeleton.offsets_m[index], skeleton.segment_ends_m[index], least, greatest];
        ensure(vectors.iter().all(|vector| vector.is_finite()), || format!("{} is not finite", joint.name()))?;
        ensure(least.cmple(greatest).all(), || format!("the limits of {} are reversed", joint.name()))?;
        let radius_m = skeleton.segment_radii_m[index];
        ensure(radius_m > 0.0 && radius_m < 1.0, || format!("{} has radius {radius_m} m", joint.name()))?;
    }
    for foot in &skeleton.feet {
        let mut points = [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m);
        ensure(points.all(|point| point.is_finite()), || "a point of a foot is not finite".into())?;
    }
    let leg_m = skeleton.leg_length_m();
    ensure((0.1..3.0).contains(&leg_m), || format!("legs are {leg_m} m long"))
}

/// Every example has all its rows.
fn rows_are_complete(db: &MotionDb) -> Outcome {
    let rows = db.examples.len() * PHASE_COUNT;
    let lengths = [db.rows.rotations.len(), db.rows.pelvis_m.len(), db.rows.contacts.len()];
    let wanted = [rows * JOINT_COUNT, rows, rows];
    ensure(lengths == wanted, || format!("rotations, pelvis, contacts are {lengths:?} entries, not {wanted:?}"))
}

/// Sources, simplices and correspondences name what exists.
fn indices_are_in_range(db: &MotionDb) -> Outcome {
    let examples = db.examples.len();
    each(db, |example| {
        ensure((example.source as usize) < db.sources.len(), || format!("its source {} does not exist", example.source))
    })?;
    ensure(db.blend_space.dimension <= 3, || format!("a blend space of {} dimensions", db.blend_space.dimension))?;
    let corners = db.blend_space.dimension as usize + 1;
    let indices = &db.blend_space.simplices;
    ensure(!indices.is_empty() && indices.len().is_multiple_of(corners), || {
        format!("{} corners do not make simplices of {corners}", indices.len())
    })?;
    let pair = db.correspondence.iter().flat_map(|found| [found.semi_procedural, found.blending]);
    match indices.iter().copied().chain(pair).find(|&index| index as usize >= examples) {
        Some(index) => Err(format!("example {index} is named, but there are {examples}")),
        None => Ok(()),
    }
}

/// No two examples share a name; mirrors have `_mirrored` names' originals or stand alone.
fn names_are_unique(db: &MotionDb) -> Outcome {
    let sorted = db.examples.windows(2).find(|pair| pair[0].name >= pair[1].name);
    match sorted {
        Some(pair) => Err(format!("{} does not sort before {}", pair[0].name, pair[1].name)),
        None => Ok(()),
    }
}

/// Parameters are finite and within human reach.
fn parameters_are_human(db: &MotionDb) -> Outcome {
    each(db, |example| {
        let found = example.parameters;
        let human = found.to_vec3().is_finite()
            && found.speed_mps.abs() <= SPEED_LIMIT_MPS
            && found.strafe_mps.abs() <= SPEED_LIMIT_MPS
            && found.turn_rate_rad_s.abs() <= TURN_LIMIT_RAD_S;
        ensure(human, || format!("{found:?}"))
    })
}

/// Time rises with phase in every example.
fn phase_maps_rise(db: &MotionDb) -> Outcome {
    each(db, |example| {
        let map = example.phase_map;
        let sound = map.period_s > 0.05 && map.period_s < 60.0 && (map.left_share - 0.5).abs() <= MAX_ASYMMETRY;
        ensure(sound, || format!("{map:?}"))
    })
}

/// Key times are seconds within one period; slide and share are figures.
fn key_times_lie_in_the_cycle(db: &MotionDb) -> Outcome {
    each(db, |example| {
        let period_s = example.phase_map.period_s;
        let inside = |times: &[f32; 4]| times.iter().all(|time_s| (0.0..period_s).contains(time_s));
        ensure(example.key_times_s.as_ref().is_none_or(inside), || {
            format!("{:?} in {period_s} s", example.key_times_s)
        })?;
        let sane = example.planted_slide_cm_s >= 0.0 && (0.0..=1.0).contains(&example.planted_share);
        ensure(sane, || format!("slide {} cm/s over {}", example.planted_slide_cm_s, example.planted_share))
    })
}

/// Rows are finite, pelvises over the ground and contacts within [0, 1].
fn rows_are_finite(db: &MotionDb) -> Outcome {
    let leg_m = db.skeleton.leg_length_m();
    for (row, (pelvis_m, contacts)) in db.rows.pelvis_m.iter().zip(&db.rows.contacts).enumerate() {
        let place = || format!("{}, phase {}", db.examples[row / PHASE_COUNT].name, row % PHASE_COUNT);
        let near = pelvis_m.is_finite() && pelvis_m.truncate().length() < 2.0 * leg_m && pelvis_m.z > 0.0;
        ensure(near && pelvis_m.z < 3.0 * leg_m, || format!("{}: pelvis at {pelvis_m}", place()))?;
        ensure(contacts.iter().all(|contact| (0.0..=1.0).contains(contact)), || format!("{}: {contacts:?}", place()))?;
    }
    Ok(())
}

/// Rotations are unit quaternions, and every row lies in the first row's hemisphere, joint by joint.
fn rotations_are_unit_and_aligned(db: &MotionDb) -> Outcome {
    let first = db.rows.rotations(0, 0);
    for (entry, rotation) in db.rows.rotations.iter().enumerate() {
        let (row, joint) = (entry / JOINT_COUNT, entry % JOINT_COUNT);
        let place = || {
            format!(
                "{}, phase {}, {}",
                db.examples[row / PHASE_COUNT].name,
                row % PHASE_COUNT,
                Joint::ALL[joint].name()
            )
        };
        ensure((rotation.length() - 1.0).abs() < UNIT_TOLERANCE, || format!("{}: {rotation}", place()))?;
        ensure(rotation.dot(first[joint]) >= -UNIT_TOLERANCE, || format!("{}: in the other hemisphere", place()))?;
    }
    Ok(())
}

/// The step from the last row to the first is no larger than twice the largest within the cycle.
fn cycles_close(db: &MotionDb) -> Outcome {
    for (index, example) in db.examples.iter().enumerate() {
        let step = |phase: usize| {
            let (here, next) = (db.rows.rotations(index, phase), db.rows.rotations(index, (phase + 1) % PHASE_COUNT));
            (0..JOINT_COUNT).map(|joint| here[joint].angle_between(next[joint])).fold(0.0, f32::max)
        };
        let largest = (0..PHASE_COUNT - 1).map(step).fold(0.0, f32::max);
        let seam = step(PHASE_COUNT - 1);
        ensure(seam <= SEAM_LIMIT * largest + UNIT_TOLERANCE, || {
            format!("{}: the seam turns a joint by {seam} rad, the cycle by at most {largest} a row", example.name)
        })?;
    }
    Ok(())
}

/// Twice the signed area of (a, b, c): positive where they turn left.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f32 {
    (b - a).perp_dot(c - a)
}

/// Both hulls turn right at every corner and hold the origin.
fn hulls_are_clockwise_and_convex(db: &MotionDb) -> Outcome {
    let hulls = [("turning", &db.velocity_hull.turning_mps), ("holding", &db.velocity_hull.holding_mps)];
    for (name, hull) in hulls {
        ensure(!hull.is_empty() && hull.iter().all(|corner| corner.is_finite()), || {
            format!("the {name} set is empty")
        })?;
        let corner = |k: usize| hull[k % hull.len()];
        let convex = hull.len() < 3 || (0..hull.len()).all(|k| turn(corner(k), corner(k + 1), corner(k + 2)) < 0.0);
        ensure(convex, || format!("the {name} set does not turn right at every corner"))?;
        ensure(hull_distance_mps(hull, Vec2::ZERO) <= HULL_TOLERANCE_MPS, || {
            format!("the {name} set lacks the origin")
        })?;
    }
    Ok(())
}

/// How far a point lies outside a clockwise hull; sets of one or two corners count as hulls too.
fn hull_distance_mps(hull: &[Vec2], point: Vec2) -> f32 {
    let corner = |k: usize| hull[k % hull.len()];
    let outside = |k: usize| {
        let edge = corner(k + 1) - corner(k);
        if edge == Vec2::ZERO { point.distance(corner(k)) } else { edge.normalize().perp_dot(point - corner(k)) }
    };
    (0..hull.len()).map(outside).fold(f32::NEG_INFINITY, f32::max)
}

/// Each set holds the examples that belong to it.
fn hulls_hold_their_examples(db: &MotionDb) -> Outcome {
    each(db, |example| {
        let found = &example.parameters;
        let holding = Vec2::new(found.speed_mps, found.strafe_mps);
        let in_turning = !is_turning(found)
            || hull_distance_mps(&db.velocity_hull.turning_mps, turning_point_mps(found)) <= HULL_TOLERANCE_MPS;
        let in_holding =
            !is_holding(found) || hull_distance_mps(&db.velocity_hull.holding_mps, holding) <= HULL_TOLERANCE_MPS;
        ensure(in_turning && in_holding, || "its velocity lies outside its own set".into())
    })
}

/// Every sharp-turn edge has the origin on its right, so that standing is always allowed.
fn sharp_turn_edges_hold_the_origin(db: &MotionDb) -> Outcome {
    let mut edges = db.velocity_hull.sharp_turn_edges_mps.iter();
    let holds = |[from, to]: &[Vec2; 2]| {
        from.is_finite() && to.is_finite() && turn(*from, *to, Vec2::ZERO) <= HULL_TOLERANCE_MPS
    };
    match edges.find(|edge| !holds(edge)) {
        Some(edge) => Err(format!("{edge:?}")),
        None => Ok(()),
    }
}

/// The simplices have volume and fill the examples' convex hull.
fn simplices_cover_the_examples(db: &MotionDb) -> Outcome {
    let ranges = db.blend_space.axis_ranges;
    ensure(ranges.iter().all(|range| range.is_finite() && *range >= 0.0), || format!("axis ranges {ranges:?}"))?;
    let share = db.blend_space.covered_share;
    ensure((share - 1.0).abs() <= COVERED_TOLERANCE, || format!("they cover a share of {share}"))
}

/// Pairs lie in their cycles, rise in t_sp, and rise in t_mb but for one wrap.
fn correspondences_are_cyclic(db: &MotionDb) -> Outcome {
    let Some(found) = &db.correspondence else { return Ok(()) };
    let period_s = |index: u32| db.examples[index as usize].phase_map.period_s;
    let (first_s, second_s) = (period_s(found.semi_procedural), period_s(found.blending));
    let pairs = &found.pairs_s;
    let inside = pairs.iter().all(|[sp, mb]| (0.0..first_s).contains(sp) && (0.0..second_s).contains(mb));
    ensure(inside && !pairs.is_empty(), || format!("{pairs:?} in {first_s} s and {second_s} s"))?;
    let next = |k: usize| pairs[(k + 1) % pairs.len()];
    let falls = |axis: usize| (0..pairs.len()).filter(|&k| next(k)[axis] <= pairs[k][axis]).count();
    ensure(pairs.len() == 1 || (falls(0) == 1 && falls(1) == 1), || format!("{pairs:?} are not cyclic"))
}

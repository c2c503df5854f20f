//! Every invariant of a database, by name. The runtime relies on all of them, so [`crate::files::database_file::load`] refuses what
//! breaks one.
//!
//! Three tiers, each of which the next relies on: `structure` (lengths and indices), `values` (what a number, a
//! rotation or a pose may be), and what must follow from the values: the motion's own account of each example
//! (`motion`), the velocity sets (`velocity_sets`, `FbCrowd` §4.1), simplices and correspondences (`blending`, §5). Of
//! a broken tier all faults are named, of the structure the first; later tiers are left out. The doc of each function
//! is the invariant.

mod blending;
mod motion;
mod structure;
mod values;
mod velocity_sets;

use crate::motion::motion_db::{MotionDb, MotionExample};

pub use motion::contradiction;

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

/// In order of dependence.
const STRUCTURE: [Invariant; 4] = [
    ("has_examples", structure::has_examples),
    ("rows_are_complete", structure::rows_are_complete),
    ("indices_are_in_range", structure::indices_are_in_range),
    ("names_are_unique", structure::names_are_unique),
];

const VALUES: [Invariant; 7] = [
    ("skeleton_is_a_body", values::skeleton_is_a_body),
    ("sources_are_finite", values::sources_are_finite),
    ("windows_are_ordered", values::windows_are_ordered),
    ("parameters_are_human", values::parameters_are_human),
    ("phase_maps_rise", values::phase_maps_rise),
    ("rows_are_finite", values::rows_are_finite),
    ("rotations_are_unit_and_aligned", values::rotations_are_unit_and_aligned),
];

const CONSEQUENCES: [Invariant; 11] = [
    ("cycles_close", motion::cycles_close),
    ("landmarks_are_mid_stances", motion::landmarks_are_mid_stances),
    ("key_times_end_contacts", motion::key_times_end_contacts),
    ("planted_feet_slide_as_stored", motion::planted_feet_slide_as_stored),
    ("parameters_follow_from_the_motion", motion::parameters_follow_from_the_motion),
    ("hulls_are_clockwise_and_convex", velocity_sets::hulls_are_clockwise_and_convex),
    ("hulls_wrap_their_examples", velocity_sets::hulls_wrap_their_examples),
    ("half_planes_agree_with_the_hulls", velocity_sets::half_planes_agree_with_the_hulls),
    ("sharp_turns_wrap_the_turning_examples", velocity_sets::sharp_turns_wrap_the_turning_examples),
    ("simplices_tile_the_hull", blending::simplices_tile_the_hull),
    ("correspondences_are_cyclic", blending::correspondences_are_cyclic),
];

/// All invariants; where a tier is broken, only those up to it.
pub fn validate(db: &MotionDb) -> Vec<Check> {
    let check = |(name, invariant): Invariant| Check { name, broken: invariant(db).err() };
    let is_broken = |check: &Check| check.broken.is_some();
    let mut checks = Vec::new();
    for invariant in STRUCTURE {
        checks.push(check(invariant));
        if checks.last().is_some_and(is_broken) {
            return checks;
        }
    }
    checks.extend(VALUES.map(check));
    if !checks.iter().any(is_broken) {
        checks.extend(CONSEQUENCES.map(check));
    }
    checks
}

/// The first invariant that a database breaks, and where and how; none of a sound one.
pub fn first_broken(db: &MotionDb) -> Option<(&'static str, String)> {
    validate(db).into_iter().find_map(|check| Some((check.name, check.broken?)))
}

fn ensure<E>(holds: bool, fault: impl FnOnce() -> E) -> Result<(), E> {
    if holds { Ok(()) } else { Err(fault()) }
}

/// Checks every example, by index; a fault names its example.
fn each(db: &MotionDb, check: impl Fn(usize, &MotionExample) -> Outcome) -> Outcome {
    let named = |(index, example): (usize, &MotionExample)| {
        check(index, example).map_err(|detail| format!("{}: {detail}", example.name))
    };
    db.examples.iter().enumerate().try_for_each(named)
}

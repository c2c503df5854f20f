//! Every invariant of a database, by name. The runtime relies on all of them, so
//! [`load`](crate::files::database_file::load) rejects a database that breaks one.
//!
//! Enters: a database of any content. Leaves: for each invariant, its stable name and its fault. Faults are texts for
//! people; programs read the name.
//!
//! Three tiers, each based on the one before: `structure` (lengths and indices), `values` (ranges of numbers, rotations
//! and poses), and consequences of the values: the motion of each example (`motion`), the velocity sets
//! (`velocity_sets`, `FbCrowd` §4.1), simplices and correspondences (`blending`, §5). `actions` has the invariants of
//! actions in all tiers, `extra_joints` those of the joints beside the 22 roles, `styles` those between the styles of a
//! set. If `structure` fails, only its first fault is reported. In later tiers, all faults are. After a failed tier, later
//! tiers are not checked. The doc of each function states the invariant.

mod actions;
mod blending;
mod extra_joints;
mod motion;
mod structure;
mod styles;
mod values;
mod velocity_sets;

use crate::motion::motion_db::{MotionDb, MotionExample};

pub use motion::{contradiction, is_open};
pub use styles::is_style_name;

/// The check of one invariant.
///
/// ```
/// use motiondb::MotionDb;
/// use motiondb::validate::{first_broken, validate};
///
/// fn print_faults(db: &MotionDb) {
///     for check in validate(db) {
///         println!("{}: {}", check.name, check.broken.as_deref().unwrap_or("holds"));
///     }
///     assert_eq!(first_broken(db).is_none(), validate(db).iter().all(|check| check.broken.is_none()));
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Stable name of the invariant.
    pub name: &'static str,
    /// The fault and its position, as a text for people; `None` if the invariant holds.
    pub broken: Option<String>,
}

/// Result of a check: an error is the fault and its position, as a text for people.
type CheckResult = Result<(), String>;

/// Name and check of an invariant.
type Invariant = (&'static str, fn(&MotionDb) -> CheckResult);

/// First tier: lengths, indices and names, each based on those before.
const STRUCTURE: [Invariant; 7] = [
    ("styles_are_unique", styles::styles_are_unique),
    ("has_examples", structure::has_examples),
    ("rows_are_complete", structure::rows_are_complete),
    ("indices_are_in_range", structure::indices_are_in_range),
    ("names_are_unique", structure::names_are_unique),
    ("actions_are_complete", actions::actions_are_complete),
    ("extra_joints_are_complete", extra_joints::extra_joints_are_complete),
];

/// Second tier: values, each by itself.
const VALUES: [Invariant; 11] = [
    ("styles_share_the_skeleton", styles::styles_share_the_skeleton),
    ("skeleton_is_a_body", values::skeleton_is_a_body),
    ("sources_are_finite", values::sources_are_finite),
    ("windows_are_ordered", values::windows_are_ordered),
    ("parameters_are_human", values::parameters_are_human),
    ("phase_maps_rise", values::phase_maps_rise),
    ("rows_are_finite", values::rows_are_finite),
    ("rotations_are_unit_and_aligned", values::rotations_are_unit_and_aligned),
    ("action_frames_are_finite", actions::action_frames_are_finite),
    ("action_rotations_are_unit_and_aligned", actions::action_rotations_are_unit_and_aligned),
    ("extra_rotations_are_unit_and_aligned", extra_joints::extra_rotations_are_unit_and_aligned),
];

/// Third tier: consequences of the values.
const CONSEQUENCES: [Invariant; 15] = [
    ("cycles_close", motion::cycles_close),
    ("landmarks_are_mid_stances", motion::landmarks_are_mid_stances),
    ("key_times_end_contacts", motion::key_times_end_contacts),
    ("planted_feet_slide_as_stored", motion::planted_feet_slide_as_stored),
    ("parameters_follow_from_the_motion", motion::parameters_follow_from_the_motion),
    ("idles_are_loops", actions::idles_are_loops),
    ("actions_meet_their_examples", actions::actions_meet_their_examples),
    ("transitions_move_as_their_kind", actions::transitions_move_as_their_kind),
    ("transitions_have_no_jumps", actions::transitions_have_no_jumps),
    ("hulls_are_clockwise_and_convex", velocity_sets::hulls_are_clockwise_and_convex),
    ("hulls_wrap_their_examples", velocity_sets::hulls_wrap_their_examples),
    ("half_planes_agree_with_the_hulls", velocity_sets::half_planes_agree_with_the_hulls),
    ("sharp_turns_wrap_the_turning_examples", velocity_sets::sharp_turns_wrap_the_turning_examples),
    ("simplices_tile_the_hull", blending::simplices_tile_the_hull),
    ("correspondences_are_cyclic", blending::correspondences_are_cyclic),
];

/// Checks of all invariants; after a failed tier, later tiers are left out. The fault of a further style names it.
pub fn validate(db: &MotionDb) -> Vec<Check> {
    let mut checks = validate_style(db);
    for style in &db.further_styles {
        let named = |broken: String| format!("style `{}`: {broken}", style.style);
        for Check { name, broken } in validate_style(style) {
            let broken = broken.map(named);
            match checks.iter_mut().find(|check| check.name == name) {
                Some(check) => check.broken = check.broken.take().or(broken),
                None => checks.push(Check { name, broken }),
            }
        }
    }
    checks
}

/// Checks of all invariants of a database without its further styles.
fn validate_style(db: &MotionDb) -> Vec<Check> {
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

/// Name and fault of the first invariant that a database breaks; `None` for a valid database.
pub fn first_broken(db: &MotionDb) -> Option<(&'static str, String)> {
    validate(db).into_iter().find_map(|check| Some((check.name, check.broken?)))
}

fn ensure<E>(holds: bool, fault: impl FnOnce() -> E) -> Result<(), E> {
    if holds { Ok(()) } else { Err(fault()) }
}

/// Checks every example, given by index; a fault names its example.
fn each(db: &MotionDb, check: impl Fn(usize, &MotionExample) -> CheckResult) -> CheckResult {
    let named = |(index, example): (usize, &MotionExample)| {
        check(index, example).map_err(|detail| format!("{}: {detail}", example.name))
    };
    db.examples.iter().enumerate().try_for_each(named)
}

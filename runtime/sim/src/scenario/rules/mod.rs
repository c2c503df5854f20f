//! The rules of every scenario, whether read or made in code.
//!
//! Enters: a scenario. Leaves: nothing, or the first broken rule with the part that breaks it.
//!
//! Read `check` (all rules, cheapest first); then `ground_check` (walls), `behaviour_check` (goals, states, signals),
//! `source_check` with `schedule_check`, `measure_check` (lines, areas, zones), `zone_check` (zones that are closed to some
//! agents), `marking_check` (markings, labels), `camera_check` and `variation_check`.

pub(crate) mod behaviour_check;
pub(crate) mod camera_check;
pub(crate) mod check;
pub(crate) mod ground_check;
pub(crate) mod marking_check;
pub(crate) mod measure_check;
pub(crate) mod schedule_check;
pub(crate) mod shot_check;
mod source_check;
mod variation_check;
mod zone_check;

pub use check::check;

//! Quality: the ground contact of planted feet, the measures of each example and action, and the coverage gaps of the
//! set.
//!
//! Enters: a valid database. Leaves: measures with thresholds, and sentences for people. Poor quality does not make a
//! database invalid; [`validate`](crate::validate) decides that.
//!
//! Read `planted_feet`, then `example_quality` and `action_quality` with `body_figures` and `finding`, then `coverage`.

pub mod action_quality;
pub(crate) mod body_figures;
pub mod coverage;
pub mod example_quality;
pub mod finding;
pub mod planted_feet;

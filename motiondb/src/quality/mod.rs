//! Quality: the ground contact of planted feet, the figures of each example, and the coverage gaps of the set.
//!
//! Enters: a valid database. Leaves: figures with thresholds, and sentences for people. Nothing here makes a database
//! unsound: the chapter `validate` decides that.
//!
//! Read `planted_feet`, then `example_quality`, then `coverage`.

pub mod coverage;
pub mod example_quality;
pub mod planted_feet;

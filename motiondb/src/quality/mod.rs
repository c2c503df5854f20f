//! Quality: how good the examples are, where the set is thin, what planted feet do on the ground.
//!
//! Read `planted_feet`, then `example_quality`, then `coverage`.

pub mod coverage;
pub mod example_quality;
pub mod planted_feet;

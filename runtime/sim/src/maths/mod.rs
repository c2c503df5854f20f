//! Geometry and numbers that several chapters use: angles, arcs, polygons, distances, exponential decay, Morton
//! codes, random numbers.
//!
//! Each file stands alone.

pub(crate) mod angle;
pub(crate) mod arc;
pub(crate) mod decay;
pub(crate) mod morton;
pub mod polygon;
pub(crate) mod random;
pub(crate) mod segment_distance;
pub(crate) mod sweep;

pub use angle::wrap_rad;
pub use arc::{moved_root, parameters_between};
pub use random::SplitMix64;

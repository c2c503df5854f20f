//! Geometry and numbers that several chapters use: angles, polygons, distances, exponential decay, random numbers.
//!
//! Each file stands alone.

pub mod angle;
pub mod arc;
pub mod decay;
pub mod polygon;
pub mod random;
pub mod segment_distance;
pub(crate) mod sweep;

//! Velocity sets: which velocities the examples let a body walk at (`FbCrowd` §4.1, Eqs. 2–5).
//!
//! Read `velocity_hull`, then `convex_hull` and `wrapping_polygon` (Fig. 3b).

pub(crate) mod convex_hull;
pub mod velocity_hull;
pub(crate) mod wrapping_polygon;

//! Half-planes of permitted velocities (`FbCrowd` §4.4, App. 9; van den Berg et al. 2011).
//!
//! Enters: an agent's disc, its neighbours, the edges of walls. Leaves: half-planes, each with its source, and the velocity
//! that satisfies them best.
//!
//! Read `half_plane`, then `agents` and `walls`, which build them, then `linear_program`, which solves them.

pub(crate) mod agents;
pub(crate) mod half_plane;
pub(crate) mod linear_program;
pub(crate) mod walls;

pub use agents::Disc;
pub use half_plane::{HalfPlane, Source};
pub use linear_program::Solution;

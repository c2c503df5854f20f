//! Half-planes of permitted velocities, and the linear programs over them (`FbCrowd` §4.4, App. 9; van den Berg et al.
//! 2011).
//!
//! Enters: an agent's disc, its neighbours, the edges of walls. Leaves: half-planes, each with its source, and the
//! velocity that satisfies them best.
//!
//! Read `half_plane`, then `agent_half_planes` and `wall_half_planes`, which build them, then `linear_program`, which
//! solves them.

pub(crate) mod agent_half_planes;
pub(crate) mod half_plane;
pub(crate) mod linear_program;
pub(crate) mod wall_half_planes;

pub use half_plane::{HalfPlane, HalfPlaneSource};
pub use linear_program::Solution;

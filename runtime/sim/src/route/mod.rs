//! Routes: from an agent's goals to its preferred velocity (`FbCrowd` §3). The route is stage 1 of a step.
//!
//! Enters: an agent's waypoints, the walls, the agent's position. Leaves: v_pref, and whether the agent has arrived.
//!
//! Read `path` (v_pref along waypoints), then `arrival` (when an agent has arrived), then `blocked_paths` (straight
//! paths that a wall crosses, for reports).

pub(crate) mod arrival;
pub(crate) mod blocked_paths;
pub mod field;
pub mod mesh;
pub(crate) mod path;

pub use blocked_paths::{BlockedPaths, blocked_paths};
pub use path::{Braking, PathProgress, preferred_mps};

//! Routes: from an agent's goals to its preferred velocity (`FbCrowd` §6).
//!
//! Enters: waypoints, walls, the agent's position. Leaves: v_pref, and whether the agent has arrived.
//!
//! Read `path`, then `arrival`, then `blocked_paths`, which reports walls across the straight paths.

pub(crate) mod arrival;
pub(crate) mod blocked_paths;
pub(crate) mod path;

pub use arrival::Arrival;
pub use blocked_paths::{BlockedWays, blocked_ways};
pub use path::{Braking, Progress, preferred_mps};

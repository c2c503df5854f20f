//! Routes: from an agent's goals to its preferred velocity (`FbCrowd` §6).
//!
//! Enters: waypoints, walls, the agent's position. Leaves: v_pref, and whether the agent has arrived.
//!
//! Read `path`, then `arrival`, then `blocked_paths`, which reports walls across the straight paths.

pub mod arrival;
pub mod blocked_paths;
pub mod path;

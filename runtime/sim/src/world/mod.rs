//! What surrounds an agent: other agents and walls.
//!
//! Enters: positions, velocities and radii of all agents; polygons. Leaves: the nearest neighbours and edges of one agent,
//! with times to collision.
//!
//! Read `neighbours` with `neighbour_lanes`, then `obstacles`, then `time_to_collision`.

pub(crate) mod neighbour_lanes;
pub mod neighbours;
pub mod obstacles;
pub(crate) mod time_to_collision;

pub use neighbour_lanes::{Around, Lanes};

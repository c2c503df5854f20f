//! What surrounds an agent: other agents and walls.
//!
//! Enters: positions, velocities and radii of all agents; the polygons of the obstacles. Leaves: the nearest neighbours
//! and wall edges of one agent, and the times to collision with them.
//!
//! Read `disc`, then [`neighbours`], [`obstacles`] and `time_to_collision`. `one_way` is a zone
//! with one direction; `segment` is the geometry that walls share.

pub(crate) mod disc;
pub mod neighbours;
pub mod obstacles;
pub mod one_way;
pub(crate) mod segment;
pub(crate) mod time_to_collision;

pub use disc::Disc;

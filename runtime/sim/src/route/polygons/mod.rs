//! Free space as polygons: where the centre of an agent that keeps its distance from walls can be.
//!
//! Enters: obstacles and walkable polygons, the distance from walls. Leaves: the contours of the free space.
//!
//! Read along the data: `ground` (input), `grid` (1/1024 m), `outline` (one obstacle), `growth` (by the distance),
//! `union`, `free_space`.

pub(crate) mod error;
pub(crate) mod free_space;
pub(crate) mod grid;
pub(crate) mod ground;
pub(crate) mod growth;
pub(crate) mod outline;
pub(crate) mod union;

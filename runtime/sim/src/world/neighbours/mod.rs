//! The nearest neighbours of an agent: a search over grids that follow the crowd's density (`FbCrowd` §4.4).
//!
//! Enters: positions, velocities and radii of all agents, once a step; then a query per agent. Leaves: at most ten
//! neighbours per query, as a list and as arrays for SIMD kernels.
//!
//! Read `neighbour`, then `rank` (order of neighbours by relevance), `search` (visits few cells), `cell_layout` (memory
//! order), `neighbour_lanes` (neighbours as arrays for SIMD kernels).

pub(crate) mod cell_layout;
pub(crate) mod neighbour;
pub(crate) mod neighbour_lanes;
pub(crate) mod rank;
pub(crate) mod search;
#[cfg(test)]
mod tests;

pub use neighbour::{NEIGHBOUR_COUNT, Neighbour, NeighbourQuery};
pub use neighbour_lanes::{Lanes, NeighbourLanes};
pub use search::{NearestNeighbours, NeighbourSearch};

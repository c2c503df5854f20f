//! Walls: simple polygons whose edges the planner avoids and whose insides no root enters.
//!
//! Enters: the polygons of a scenario, once. Leaves: the edges near an agent, whether a straight path is free, and the
//! position at which a disc stops at a wall.
//!
//! Read `polygons`, then `clamp`; `edge_grid` finds what is near.

pub(crate) mod clamp;
pub(crate) mod edge_grid;
pub(crate) mod polygons;

pub use polygons::{NearEdge, ObstacleCorner, Obstacles};

//! Walls: simple polygons whose edges the planner avoids and whose insides no root enters.
//!
//! Enters: the polygons of a scenario, once. Leaves: the edges near an agent, whether a straight path is free, and the
//! position at which a disc stops at a wall.
//!
//! Read `polygons`, then `clamp`; `edge_grid` finds what is near; `zone_walls` are those of some agents.

pub(crate) mod clamp;
pub(crate) mod edge_grid;
pub(crate) mod polygons;
pub(crate) mod zone_walls;

pub use polygons::{NearEdge, ObstacleCorner, Obstacles};
pub use zone_walls::ZoneWalls;

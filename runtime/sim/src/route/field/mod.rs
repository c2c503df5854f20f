//! Shortest routes over the mesh: from any position, the distance to a goal and the corners on the route.
//!
//! Enters: a mesh, goals. Leaves: a field for each goal, which answers for every position, or one route between two
//! positions.
//!
//! Read `route_goal`, then `interval` (what a corner sees through an edge), `flood` (the search from the goal),
//! `route_field` (the search kept, and queries), `shortest_route` (one pair of positions).

pub(crate) mod flood;
pub(crate) mod interval;
pub(crate) mod route_field;
pub(crate) mod route_goal;
pub(crate) mod shortest_route;

#[cfg(test)]
mod tests;

pub use route_field::{RouteField, RoutePosition, RouteStep};
pub use route_goal::RouteGoal;
pub use shortest_route::{ShortestRoute, shortest_route};

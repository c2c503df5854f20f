//! Routes: from an agent's goals to its preferred velocity (`FbCrowd` §3). The route is stage 1 of a step.
//!
//! Enters: an agent's waypoints, the walls, the agent's position. Leaves: v_pref, the direction that the agent faces, and
//! whether it has arrived.
//!
//! Read `polygons` (free space), [`mesh`] (its triangles) and [`field`] (shortest routes over it); then `crowd_routes`
//! (the routes of all agents), `door_routes` (while doors are closed), `steering` (direction before a corner), `path`
//! (v_pref and facing along waypoints) with `rounded_waypoint`, `braking` and `standing_position`, and `arrival` (when an
//! agent has arrived); `reach` finds unreachable goals and closed passages before a simulation, with `area_reach` (areas)
//! and `one_way_reach` (one-way zones).
//!
//! ```
//! use fbcrowd_sim::route::field::{RouteField, RouteGoal, RoutePosition};
//! use fbcrowd_sim::route::mesh::{Ground, RouteMesh};
//! use glam::Vec2;
//!
//! # fn main() -> Result<(), fbcrowd_sim::route::mesh::RouteError> {
//! let wall_m = [[0.0, -5.0], [0.1, -5.0], [0.1, 5.0], [0.0, 5.0]].map(Vec2::from).to_vec();
//! let (start_m, goal_m) = (Vec2::new(-3.0, 4.0), Vec2::new(3.0, 4.0));
//! let ground = Ground { obstacles_m: &[wall_m], points_m: &[start_m, goal_m], ..Ground::default() };
//! let mesh = RouteMesh::new(&ground, 0.2)?;
//! let field = RouteField::new(&mesh, RouteGoal::Points(vec![goal_m]));
//! let mut remembered = RoutePosition::default();
//! let step = field.step(&mesh, start_m, &mut remembered).expect("both lie outside the wall");
//! assert!(step.distance_m > 6.4 && step.next_m.y > 5.1);
//! # Ok(())
//! # }
//! ```

pub(crate) mod area_reach;
pub(crate) mod arrival;
pub(crate) mod braking;
pub mod crowd_routes;
pub(crate) mod door_routes;
pub mod field;
pub mod mesh;
pub(crate) mod one_way_reach;
pub(crate) mod params;
pub(crate) mod path;
pub(crate) mod polygons;
pub(crate) mod reach;
pub(crate) mod rounded_waypoint;
pub(crate) mod standing_position;
pub(crate) mod steering;

pub use braking::Braking;
pub use crowd_routes::{CrowdRoutes, NextCorner, RouteMemory};
pub use door_routes::ClosedDoors;
pub use params::{KeepSide, RouteParams};
pub use path::{PathProgress, PreferredMotion, RouteView, preferred_motion};
pub use reach::{ClosedToAgents, closed_to_agents};
pub use standing_position::StandingPosition;

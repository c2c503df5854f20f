//! Crowd simulation with full bodies: a planner that knows what human bodies can do, and motion synthesis that follows
//! it (`FbCrowd`). For the runtime of tools and applications; motion databases come from the compiler
//! (`motiondb-compiler`).
//!
//! Two agents that walk past each other, on a database that `fbcrowd compile` wrote:
//!
//! ```no_run
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! use fbcrowd_sim::{AgentSpec, Scenario, Simulation};
//! use glam::Vec2;
//! use motiondb::files::database_file;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (db, _checksum) = database_file::load(Path::new("motion.fbdb"))?;
//! let agent = |start_m: Vec2, goal_m: Vec2| AgentSpec {
//!     position_m: start_m,
//!     facing_rad: (goal_m - start_m).to_angle(),
//!     goals_m: vec![goal_m],
//!     radius_m: 0.25,
//!     wall_radius_m: 0.2,
//!     preferred_speed_mps: 1.33,
//!     ..AgentSpec::default()
//! };
//! let (west_m, east_m) = (Vec2::new(-4.0, 0.0), Vec2::new(4.0, 0.0));
//! let scenario = Scenario::of(vec![agent(west_m, east_m), agent(east_m, west_m)]);
//! let mut simulation = Simulation::new(Arc::new(db), &scenario);
//! for _ in 0..150 {
//!     simulation.step(&mut |_stage| {});
//! }
//! for agent in simulation.frames() {
//!     println!("root at {} m, facing {:.2} rad", agent.root.position_m, agent.root.facing_rad);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! Planning alone, without bodies and without a database: one plan per agent, from a frozen view of the world.
//!
//! ```
//! use fbcrowd_sim::planning::mcn::MotionConstraints;
//! use fbcrowd_sim::planning::{CrowdPlanningMemory, Stance, plan_all, ranking_horizon_s};
//! use fbcrowd_sim::world::neighbours::NeighbourSearch;
//! use fbcrowd_sim::world::obstacles::Obstacles;
//! use fbcrowd_sim::{Params, Plan, Planner, WorldView};
//! use glam::Vec2;
//! use motiondb::velocity_sets::velocity_hull::VelocityHull;
//!
//! let (planner, params) = (Planner::Orca, Params::default());
//! let positions_m = [Vec2::new(-2.0, 0.0), Vec2::new(2.0, 0.0)];
//! let velocities_mps = [Vec2::X, -Vec2::X];
//! let radii_m = [0.25; 2];
//! let mut neighbours = NeighbourSearch::default();
//! neighbours.rebuild(&positions_m, &velocities_mps, &radii_m, ranking_horizon_s(planner, &params));
//! let world = WorldView {
//!     positions_m: &positions_m,
//!     velocities_mps: &velocities_mps,
//!     facings_rad: &[0.0, std::f32::consts::PI],
//!     radii_m: &radii_m,
//!     wall_radii_m: &[0.2; 2],
//!     preferred_mps: &velocities_mps,
//!     free_speeds_mps: &[1.3; 2],
//!     facing_offsets_rad: &[0.0; 2],
//!     stances: &[Stance::default(); 2],
//!     planned_mps: &velocities_mps,
//!     strafing_s: &[0.0; 2],
//!     stepping_back_s: &[0.0; 2],
//!     neighbours: &neighbours,
//!     obstacles: &Obstacles::default(),
//!     own_walls: None,
//!     one_way: &[],
//!     priorities: None,
//!     constraints: &MotionConstraints::new(&VelocityHull::default()),
//!     own_constraints: None,
//!     speed_factors: None,
//!     dt_s: 0.1,
//!     bodies: false,
//! };
//! let mut plans = [Plan::default(); 2];
//! plan_all(planner, &world, &params, &mut CrowdPlanningMemory::default(), &mut plans);
//! // They would collide after 3.5 m at 2 m/s; both evade.
//! assert_eq!(plans[0].time_to_collision_s, 1.75);
//! assert!(plans[0].velocity_mps.y != 0.0 && plans[1].velocity_mps.y == -plans[0].velocity_mps.y);
//! ```
//!
//! Chapters, in reading order: [`simulation`] (one step, the paper's Fig. 2), then along that step [`scenario`],
//! [`route`], [`world`], [`planning`] (§4), [`synthesis`] (§5), [`coupling`] (§3.4), [`recording`] and [`measures`];
//! [`agents`] is the state of all agents, [`population`] all that ever were, [`params`] the tunables, [`maths`] what
//! several chapters share.
//!
//! World axes: x and y on the ground, z up, right-handed. Agent frame: x forward, y left. Metres, seconds, radians;
//! angles counter-clockwise from above.

pub mod agents;
pub mod behaviour;
pub mod coupling;
pub mod maths;
pub mod measures;
pub mod params;
pub mod planning;
pub mod population;
pub mod recording;
pub mod route;
pub mod scenario;
pub mod simulation;
pub mod synthesis;
pub mod variation;
pub mod world;

#[cfg(test)]
mod test_db;

pub use agents::Removal;
pub use measures::Measures;
pub use params::Params;
pub use planning::{Plan, PlanExplanation, Planner, WorldView};
pub use population::{AgentId, Population};
pub use recording::{AgentFrame, Header, Recorder, Recording};
pub use scenario::{AgentSpec, Scenario};
pub use simulation::{Simulation, Stage};

//! The simulation: one step in the order of the paper's Fig. 2, in [`simulation`].

pub mod agents;
pub mod coupling;
pub mod maths;
pub mod measures;
pub mod params;
pub mod planning;
pub mod recording;
pub mod route;
pub mod scenario;
pub mod simulation;
pub mod synthesis;
pub mod wild;
pub mod world;

#[cfg(test)]
mod test_db;

pub use measures::Measures;
pub use params::Params;
pub use planning::{Plan, PlanExplanation, Planner, WorldView};
pub use recording::{AgentFrame, Header, Recorder, Recording};
pub use scenario::{AgentSpec, Scenario};
pub use simulation::{Simulation, Stage};

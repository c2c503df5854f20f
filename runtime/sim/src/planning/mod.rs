//! Planning: from the preferred velocity of each agent to the velocity and facing of its next step (`FbCrowd` §4).
//!
//! Enters: [`WorldView`], the frozen state of agents, walls and stance feet. Leaves: one [`Plan`] per agent.
//!
//! Read `plan` and `world_view`, then `surroundings` (the neighbours and walls near one agent), `elbow_room` and `gap` (what
//! they leave to its body) and `planner`, which chooses between [`mcn`] (the paper's) and the [`baselines`]. [`orca`] holds the
//! half-planes and linear programs that they share, `plan_all` plans a crowd, `plan_explanation` shows why a velocity was
//! planned.

pub mod baselines;
pub(crate) mod elbow_room;
pub(crate) mod gap;
pub mod mcn;
pub mod orca;
pub(crate) mod plan;
pub(crate) mod plan_all;
pub(crate) mod plan_explanation;
pub(crate) mod planner;
pub(crate) mod surroundings;
pub(crate) mod world_view;

pub use elbow_room::{ElbowRoom, RoomSide};
pub use plan::{PLANTED_CONTACT, Plan, Stance, StanceFoot, VelocitySet};
pub use plan_all::{CrowdPlanningMemory, plan_all};
pub use plan_explanation::PlanExplanation;
pub use planner::{Planner, PlannerMemory, plan, ranking_horizon_s};
pub use world_view::{OwnConstraints, OwnWalls, WorldView};

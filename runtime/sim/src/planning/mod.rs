//! Planning: from where each agent wants to go to the velocity and facing of its next step (`FbCrowd` §4).
//!
//! Enters: `world_view`, the frozen state of agents, walls and stance feet. Leaves: one `plan` per agent.
//!
//! Read `plan` and `world_view`, then `planner`, which chooses between `mcn` (the paper's) and the `baselines`;
//! `orca` holds the half-planes and programs that they share, `plan_all` plans a crowd, `explanation` shows why.

pub mod baselines;
pub(crate) mod explanation;
pub mod mcn;
pub mod orca;
pub(crate) mod plan;
pub(crate) mod plan_all;
pub(crate) mod planner;
pub(crate) mod world_view;

pub use explanation::Reasons;
pub use plan::{PLANTED_CONTACT, Plan, Stance, StanceFoot, VelocitySet};
pub use plan_all::{Memory, plan_all};
pub use planner::{Planner, Scratch, ahead_s, plan};
pub use world_view::World;

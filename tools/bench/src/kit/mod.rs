//! What benches share: arguments, reports, databases, scenes, and bodies or crowds that run.
//!
//! Read in this order: [`args`] and [`report`], the input and the output of every bench; [`statistics`] and
//! [`threads`]; the databases ([`database`]) and the scenes ([`scenes`], [`crowd`]); single bodies ([`lone_body`],
//! [`pose_sequence`]); runs of scenario files ([`scenario_run`]) and of planners side by side
//! ([`planner_comparison`]).

pub mod args;
pub(crate) mod crowd;
pub mod database;
pub(crate) mod lone_body;
pub(crate) mod planner_comparison;
pub(crate) mod pose_sequence;
pub mod report;
pub(crate) mod scenario_run;
pub(crate) mod scenes;
pub mod statistics;
pub(crate) mod threads;

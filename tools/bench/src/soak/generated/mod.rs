//! Random worlds, scenes, scenarios and linear programs, and the faults of plans, simulations and solutions in them.
//!
//! Enters: a seed. Leaves: the fault of a plan, a simulation or a solution; none if nothing is wrong. One file for each:
//! [`world`], [`turned_scene`], [`scenario`] with its text ([`scenario_text`]) and
//! [`one_way_passages`], [`linear_program`].

pub mod linear_program;
pub(crate) mod one_way_passages;
pub(crate) mod scenario;
pub(crate) mod scenario_text;
pub mod turned_scene;
pub mod world;

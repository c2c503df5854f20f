//! Random worlds, scenes and linear programs, and the faults of plans and solutions in them.
//!
//! Enters: a seed. Leaves: the fault of a plan or a solution; none if nothing is wrong. One file for each: [`world`],
//! [`turned_scene`], [`linear_program`].

pub mod linear_program;
pub mod turned_scene;
pub mod world;

//! Random worlds, scenes and linear programs, and what is wrong with what is planned in them.
//!
//! In: a seed. Out: the fault of a plan or a solution; none where nothing is wrong. One file for each: [`world`],
//! [`turned_scene`], [`linear_program`].

pub mod linear_program;
pub mod turned_scene;
pub mod world;

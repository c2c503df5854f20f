//! Benches that compare simulated crowds with pedestrian research.
//!
//! Enters: scenario files of `assets/scenarios`. Leaves: results of the RiMEA guideline's tests and of three like them
//! ([`rimea`]), and patterns that emerge in crowds ([`emergence`]; lanes are in [`two_way_flow`], the crowd before a door
//! is in [`bottleneck`]).
//!
//! A test is a [`case`]; [`guideline_cases`] lists them. They are judged in [`walking_cases`], [`fundamental_diagram`],
//! [`exit_cases`], [`passage_cases`], [`single_file`] and [`further_cases`].

pub mod bottleneck;
pub mod case;
pub mod emergence;
pub(crate) mod exit_cases;
pub mod fundamental_diagram;
pub(crate) mod further_cases;
pub(crate) mod guideline_cases;
pub(crate) mod passage_cases;
pub mod rimea;
pub(crate) mod single_file;
pub mod two_way_flow;
pub(crate) mod walking_cases;

//! Benches that compare simulated crowds with pedestrian research.
//!
//! Enters: scenario files of `assets/scenarios`. Leaves: results of the RiMEA guideline's tests and of three like them
//! ([`rimea`]; a test is a [`case`], the guideline's are in [`guideline_cases`] and [`fundamental_diagram`], the others
//! in [`further_cases`]), and patterns that emerge in crowds ([`emergence`]; lanes are in [`two_way_flow`], the crowd
//! before a door is in [`bottleneck`]).

pub mod bottleneck;
pub mod case;
pub mod emergence;
pub mod fundamental_diagram;
pub(crate) mod further_cases;
pub(crate) mod guideline_cases;
pub mod rimea;
pub mod two_way_flow;

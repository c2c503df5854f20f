//! Benches of crowds against what is known of pedestrians.
//!
//! In: scenario files of `assets/scenarios`. Out: the tests of the RiMEA guideline and three like them ([`rimea`]: what a
//! test is in [`case`], the guideline's in [`guideline_cases`] and [`fundamental_diagram`], the others in
//! [`further_cases`]), and patterns that emerge in crowds ([`emergence`]: lanes in [`two_way_flow`], the crowd before a
//! door in [`bottleneck`]).

pub mod bottleneck;
pub mod case;
pub mod emergence;
pub mod fundamental_diagram;
pub(crate) mod further_cases;
pub(crate) mod guideline_cases;
pub mod rimea;
pub mod two_way_flow;

//! Benches of speed: durations of single parts, as goals for a quiet machine and as ratios that hold on any.
//!
//! Enters: sets and crowds of growing sizes. Leaves: durations of a query of the blend space ([`blend_space`]), of the
//! synthesis of a body ([`bodies`]) and of planning ([`plan`]). The times of whole frames are a figure of the paper
//! ([`crate::paper::figure6`]).

pub mod blend_space;
pub mod bodies;
pub mod plan;

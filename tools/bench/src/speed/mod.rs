//! Benches of speed: durations of single parts, as goals for a quiet machine and as ratios that hold on any.
//!
//! Enters: sets and crowds of growing sizes. Leaves: durations of a query of the blend space ([`blend_space`]), of the
//! synthesis of a body ([`bodies`]), of planning ([`plan`]), of routes ([`routes`]) and
//! of frames of the camera view ([`render`], also with a character of `tube_character`, and beside [`cycles`]). The times
//! of whole frames are a figure of the paper ([`crate::paper::figure6`]).

pub mod blend_space;
pub mod bodies;
pub mod cycles;
pub mod plan;
pub mod render;
pub(crate) mod route_grounds;
pub mod routes;
pub(crate) mod tube_character;

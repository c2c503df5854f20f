//! Command: from a plan to the (v_f, ω_t, ω_s) that a body carries out.
//!
//! Enters: a plan. Leaves: parameters for the blend, whether the body stands or steps, and how fast its phase runs.
//!
//! Read in the order of a step: `displacement_accumulator`, `blend_query`, `command_filter`, `stand_or_step`,
//! `phase_catch_up`.

pub(crate) mod blend_query;
pub(crate) mod command_filter;
pub(crate) mod displacement_accumulator;
pub(crate) mod phase_catch_up;
pub(crate) mod stand_or_step;

pub use blend_query::asking;
pub use command_filter::Intention;
pub use displacement_accumulator::Owed;
pub use phase_catch_up::Hurry;
pub use stand_or_step::{Gait, START_IDLE_SHARE};

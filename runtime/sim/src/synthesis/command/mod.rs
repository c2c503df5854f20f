//! Command: from a plan to the (v_f, ω_t, ω_s) that a body carries out.
//!
//! Enters: a plan. Leaves: parameters for the blend, whether the body stands or steps, and how fast its phase runs.
//!
//! Read in the order of a step: `displacement_accumulator`, `blend_query`, `command_filter`, `stand_or_step`,
//! `phase_catch_up`.

pub mod blend_query;
pub mod command_filter;
pub mod displacement_accumulator;
pub mod phase_catch_up;
pub mod stand_or_step;

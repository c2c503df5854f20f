//! Command: from a plan to what a body is to do, and how its mix of examples follows.
//!
//! Enters: a plan. Leaves: the command (v_f, ω_t, ω_s), what the examples reach of it, whether the body stands or
//! steps, and the shares of the examples.
//!
//! Read in the order of a step: `displacement_accumulator`, `blend_query`, `command_filter`, `step_state` (the three
//! that have state are held by `command_state`), `start_stop`, `weight_transition` with `acceleration_limit`,
//! `phase_catch_up`.

pub(crate) mod acceleration_limit;
pub(crate) mod blend_query;
pub(crate) mod command_filter;
pub(crate) mod command_state;
pub(crate) mod displacement_accumulator;
pub(crate) mod phase_catch_up;
pub(crate) mod start_stop;
pub(crate) mod step_state;
pub(crate) mod weight_transition;

pub use blend_query::plan_requesting;
pub(crate) use command_state::CommandState;
pub use step_state::START_IDLE_SHARE;

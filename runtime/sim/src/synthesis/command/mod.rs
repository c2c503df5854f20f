//! From a plan to the command (v_f, ω_t, ω_s) of a body and the weights of its examples.
//!
//! Enters: a plan. Leaves: the command, the reachable command, the state (standing or stepping), the weights.
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

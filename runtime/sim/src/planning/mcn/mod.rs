//! MCN, motion-constrained navigation (`FbCrowd` §4): computes, from the preferred velocity, a velocity that satisfies
//! the constraints of body, stance foot and crowd.
//!
//! Enters: the world view and the tunables. Leaves: the plan of one agent.
//!
//! Read `navigate`, the pipeline in the order of the paper; then its stages:
//!
//! 1. `adaptation` (§4.3): v_pref → v_op, by `keep_right`, the forces of `power_law` and the `density_filter`;
//! 2. the half-planes of `avoidance` (§4.4), `stance_half_plane` (§4.2) and `motion_constraints` (§4.1);
//! 3. `orientation` (§4.5), and `gradual_turn`, which plans it little by little; where the route leads aside or behind, agents
//!    `turn_first`.
//!
//! `params` holds the tunables and the switches of the parts, `memory` what is kept from plan to plan.

pub(crate) mod adaptation;
pub(crate) mod avoidance;
pub(crate) mod density_filter;
pub(crate) mod gradual_turn;
pub(crate) mod keep_right;
pub(crate) mod memory;
pub(crate) mod motion_constraints;
pub(crate) mod navigate;
pub(crate) mod orientation;
pub(crate) mod params;
pub(crate) mod power_law;
pub(crate) mod stance_half_plane;
#[cfg(test)]
mod tests;
pub(crate) mod turn_first;

pub use motion_constraints::{ConvexSet, MotionConstraints};
pub use params::{McnParams, McnParts, StanceForm};
pub use stance_half_plane::{TIME_TO_LANDING_MIN_S, stance_half_plane};

//! The velocities that the database can realise (`FbCrowd` §4.1, Eqs. 2–5; `definitions.md`, "Velocity constraints").
//!
//! Both sets are convex polygons in the agent's frame (x forward, y left, m/s), corners clockwise, and count the
//! origin.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::parameters::Parameters;

/// Examples with at most this side speed count as ω_s = 0 (no measured clip has exactly that), m/s.
pub const TURNING_STRAFE_MAX_MPS: f32 = 0.12;
/// Examples slower than this walk backward and belong to no turning set, m/s.
pub const TURNING_SPEED_MIN_MPS: f32 = -0.05;
/// Examples with at most this turn rate hold their facing: 10 °/s.
pub const HOLDING_TURN_MAX_RAD_S: f32 = 10.0 * std::f32::consts::PI / 180.0;

/// Which examples bound which velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Construction {
    /// A set for turning bodies and one for bodies that hold their facing (`definitions.md`).
    #[default]
    TurningAndHolding,
    /// The paper's alone, for comparison: the turning set bounds every velocity; side-stepping and backward examples
    /// bound none.
    Paper,
}

/// The velocity sets of a database.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VelocityHull {
    /// How the sets were built.
    pub construction: Construction,
    /// The paper's set: velocities that the facing will follow. Clockwise.
    pub turning_mps: Vec<Vec2>,
    /// Velocities at held facing: forward, side-stepping, backward; the turning set again in the paper's construction.
    /// Clockwise.
    pub holding_mps: Vec<Vec2>,
    /// Edges of the wrapping polygon with an end beyond ±90°, each from its clockwise-first end: the inside is on the
    /// edge's right.
    pub sharp_turn_edges_mps: Vec<[Vec2; 2]>,
}

/// Eqs. 2, 3: the point of a turning example in the agent's frame, ω_t read as the heading reached after one second.
pub fn turning_point_mps(parameters: &Parameters) -> Vec2 {
    let (sin, cos) = libm::sincosf(parameters.turn_rate_rad_s);
    Vec2::new(cos, sin) * parameters.speed_mps
}

/// Whether an example belongs to the turning set.
pub fn is_turning(parameters: &Parameters) -> bool {
    parameters.strafe_mps.abs() <= TURNING_STRAFE_MAX_MPS && parameters.speed_mps >= TURNING_SPEED_MIN_MPS
}

/// Whether an example belongs to the holding set.
pub fn is_holding(parameters: &Parameters) -> bool {
    parameters.turn_rate_rad_s.abs() <= HOLDING_TURN_MAX_RAD_S
}

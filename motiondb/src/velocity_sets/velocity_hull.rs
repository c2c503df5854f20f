//! The velocities that the database can realise (`FbCrowd` §4.1, Eqs. 2–5).
//!
//! The turning set (the paper's) is that of velocities which the facing will follow, the holding set (ours: the paper
//! bounds side-steps and steps back by the first alone) that of velocities at held facing. Both are convex polygons in
//! the agent's frame (x forward, y left, m/s), corners clockwise, and count the origin.

use std::f32::consts::PI;

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::motion::parameters::Parameters;
use crate::velocity_sets::convex_hull::clockwise_hull;
use crate::velocity_sets::wrapping_polygon::sharp_turn_edges;

/// Examples with at most this side speed count as ω_s = 0 (no measured clip has exactly that), m/s.
pub const TURNING_STRAFE_MAX_MPS: f32 = 0.12;
/// Examples slower than this walk backward and belong to no turning set, m/s.
pub const TURNING_SPEED_MIN_MPS: f32 = -0.05;
/// Examples with at most this turn rate hold their facing: 10 °/s.
pub const HOLDING_TURN_MAX_RAD_S: f32 = 10.0 * std::f32::consts::PI / 180.0;

/// Half the width given to a set without area, m/s: rounding in its rotation cannot empty it then.
pub const HALF_WIDTH_MPS: f32 = 0.01;

/// Which examples bound which velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Construction {
    /// A set for turning bodies and one for bodies that hold their facing.
    #[default]
    TurningAndHolding,
    /// The paper's alone, for comparison: the turning set bounds every velocity, side-stepping and backward examples
    /// bound none, and bodies do not step back. What the paper leaves open is as in the other: which side speeds count
    /// as 0, that the origin counts (the paper's own set has a standing example there), how the wrapping polygon is
    /// built, and that of its sharp-turn edges only the one that the turn meets applies.
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

/// Both sets and the sharp-turn edges of a database's examples.
pub fn build(parameters: &[Parameters], construction: Construction) -> VelocityHull {
    let turning = parameters.iter().filter(|found| is_turning(found));
    let turning: Vec<Vec2> = turning.map(turning_point_mps).collect();
    let holding = parameters.iter().filter(|found| is_holding(found)).map(holding_point_mps);
    let turning_mps = clockwise_hull(turning.iter().copied());
    VelocityHull {
        construction,
        holding_mps: match construction {
            Construction::TurningAndHolding => clockwise_hull(holding),
            Construction::Paper => turning_mps.clone(),
        },
        turning_mps,
        sharp_turn_edges_mps: sharp_turn_edges(&turning),
    }
}

/// Eqs. 2, 3: the point of a turning example in the agent's frame, ω_t read as the heading reached after one second. Who
/// turns faster than by half a turn a second has turned about, and comes round on no other side.
pub fn turning_point_mps(parameters: &Parameters) -> Vec2 {
    let (sin, cos) = libm::sincosf(parameters.turn_rate_rad_s.clamp(-PI, PI));
    Vec2::new(cos, sin) * parameters.speed_mps
}

/// The point of a holding example in the agent's frame.
pub fn holding_point_mps(parameters: &Parameters) -> Vec2 {
    Vec2::new(parameters.speed_mps, parameters.strafe_mps)
}

/// Whether an example belongs to the turning set.
pub fn is_turning(parameters: &Parameters) -> bool {
    parameters.strafe_mps.abs() <= TURNING_STRAFE_MAX_MPS && parameters.speed_mps >= TURNING_SPEED_MIN_MPS
}

/// Whether an example belongs to the holding set.
pub fn is_holding(parameters: &Parameters) -> bool {
    parameters.turn_rate_rad_s.abs() <= HOLDING_TURN_MAX_RAD_S
}

/// Eqs. 4, 5: the half-planes of a set in the agent's frame, one for each edge, as a point p and a unit direction d;
/// permitted are the velocities on the left. A set without area is widened into a rectangle.
pub fn half_planes(corners_mps: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> {
    let rectangle = match *corners_mps {
        [] => Some(widened(Vec2::ZERO, Vec2::ZERO)),
        [only] => Some(widened(Vec2::ZERO, only)),
        [first, second] => Some(widened(first, second)),
        _ => None,
    };
    let corner = move |k: usize| rectangle.map_or_else(|| corners_mps[k], |corners| corners[k]);
    let count = rectangle.map_or(corners_mps.len(), |corners| corners.len());
    (0..count).filter_map(move |k| half_plane(corner(k), corner(if k + 1 == count { 0 } else { k + 1 })))
}

/// p = v_i, d = (v_i − v_{i+1})/‖v_i − v_{i+1}‖; none for an edge without length.
pub fn half_plane(corner_mps: Vec2, next_mps: Vec2) -> Option<(Vec2, Vec2)> {
    Some((corner_mps, (corner_mps - next_mps).try_normalize()?))
}

/// The rectangle, clockwise, about a segment or a point.
fn widened(from_mps: Vec2, to_mps: Vec2) -> [Vec2; 4] {
    let along = (to_mps - from_mps).normalize_or(Vec2::X) * HALF_WIDTH_MPS;
    let left = along.perp();
    [from_mps - along + left, to_mps + along + left, to_mps + along - left, from_mps - along - left]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_turns_by_more_than_half_a_turn_comes_round_on_no_other_side() {
        for (turn_deg_s, y_mps) in [(90.0_f32, 1.0), (170.0, 0.17), (200.0, 0.0), (-170.0, -0.17), (-300.0, 0.0)] {
            let turn_rate_rad_s = turn_deg_s.to_radians();
            let point_mps = turning_point_mps(&Parameters { speed_mps: 1.0, turn_rate_rad_s, strafe_mps: 0.0 });
            assert!((point_mps.y - y_mps).abs() < 0.01, "{turn_deg_s} °/s: {point_mps}");
        }
    }
}

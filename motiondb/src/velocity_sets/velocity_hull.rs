//! The velocities that the examples can realise (`FbCrowd` §4.1, Eqs. 2–5).
//!
//! Two convex polygons, both with the origin, corners clockwise, in the agent's frame (x forward, y left), m/s:
//!
//! - The **turning set** is the paper's: velocities that the facing will follow.
//! - The **holding set** is an addition: velocities at held facing (the paper bounds side-steps and steps back by the
//!   turning set alone).

use std::f32::consts::PI;

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::motion::parameters::Parameters;
use crate::velocity_sets::convex_hull::clockwise_hull;
use crate::velocity_sets::wrapping_polygon::sharp_turn_edges;

/// Greatest side speed that counts as ω_s = 0, m/s; no measured clip has exactly 0.
const STRAIGHT_STRAFE_MAX_MPS: f32 = 0.12;
/// The same as a share of the forward speed, 6° aside; the greater of both limits counts.
const STRAIGHT_STRAFE_MAX_SHARE: f32 = 0.1;
/// Least forward speed of examples in the turning set, m/s; slower ones walk backward.
pub const TURNING_SPEED_MIN_MPS: f32 = -0.05;
/// Greatest turn rate of examples in the holding set, rad/s: 10 °/s.
pub const HOLDING_TURN_MAX_RAD_S: f32 = 10.0 * std::f32::consts::PI / 180.0;

/// Half the width of a set without area, m/s: rounding in its rotation then cannot make it empty.
pub const HALF_WIDTH_MPS: f32 = 0.01;

/// Which examples bound which velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Construction {
    /// One set for turning bodies, and one for bodies that hold their facing.
    #[default]
    TurningAndHolding,
    /// The paper's construction, for comparison: the turning set bounds every velocity. Examples that side-step or walk
    /// backward bound none, and bodies do not step back. Points that the paper leaves open are as in the other
    /// construction: the tolerance of ω_s = 0, the origin (the paper has a standing example there), the wrapping
    /// polygon, and that only the sharp-turn edge on the side of the turn applies.
    Paper,
}

/// The velocity sets of a database.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VelocityHull {
    /// Construction of the sets.
    pub construction: Construction,
    /// Corners of the turning set, clockwise, agent's frame, m/s.
    pub turning_mps: Vec<Vec2>,
    /// Corners of the holding set, clockwise, agent's frame, m/s. In the paper's construction: the turning set again.
    pub holding_mps: Vec<Vec2>,
    /// Edges of the wrapping polygon with an end beyond ±90°, agent's frame, m/s. Each runs clockwise: its inside is on
    /// the right.
    pub sharp_turn_edges_mps: Vec<[Vec2; 2]>,
}

/// The velocity sets and sharp-turn edges of examples with these parameters.
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

/// Point of a turning example in the agent's frame, m/s (Eqs. 2, 3). ω_t counts as the heading that is reached after
/// one second, at most half a turn.
pub fn turning_point_mps(parameters: &Parameters) -> Vec2 {
    let (sin, cos) = libm::sincosf(parameters.turn_rate_rad_s.clamp(-PI, PI)); // Eq. 2: u = (cos ω_t, sin ω_t)
    Vec2::new(cos, sin) * parameters.speed_mps // Eq. 3: v_motion = v_f · u
}

/// Point of a holding example in the agent's frame, m/s.
pub fn holding_point_mps(parameters: &Parameters) -> Vec2 {
    parameters.velocity_mps()
}

/// Whether an example belongs to the turning set.
pub fn is_turning(parameters: &Parameters) -> bool {
    faces_its_way(parameters) && parameters.speed_mps >= TURNING_SPEED_MIN_MPS
}

/// Whether a body faces the way it goes, or turns its back on it: ω_s = 0 within the tolerance.
pub fn faces_its_way(parameters: &Parameters) -> bool {
    let limit_mps = STRAIGHT_STRAFE_MAX_MPS.max(STRAIGHT_STRAFE_MAX_SHARE * parameters.speed_mps.abs());
    parameters.strafe_mps.abs() <= limit_mps
}

/// Whether a body goes straight, on or back: it neither turns nor side-steps.
pub fn goes_straight(parameters: &Parameters) -> bool {
    is_holding(parameters) && faces_its_way(parameters)
}

/// Whether an example belongs to the holding set.
pub fn is_holding(parameters: &Parameters) -> bool {
    parameters.turn_rate_rad_s.abs() <= HOLDING_TURN_MAX_RAD_S
}

/// Half-planes of a set in the agent's frame, one per edge, as a point p (m/s) and a unit direction d (Eqs. 4, 5).
/// Velocities on the left are permitted. A set without area is widened into a rectangle.
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

/// Half-plane of the edge from a corner to the next: a point and a unit direction; `None` for an edge without length.
pub fn half_plane(corner_mps: Vec2, next_mps: Vec2) -> Option<(Vec2, Vec2)> {
    Some((corner_mps, (corner_mps - next_mps).try_normalize()?)) // Eqs. 4, 5: p = v_i, d = (v_i − v_{i+1})/‖v_i − v_{i+1}‖
}

/// Rectangle around a segment or a point, clockwise.
fn widened(from_mps: Vec2, to_mps: Vec2) -> [Vec2; 4] {
    let along = (to_mps - from_mps).normalize_or(Vec2::X) * HALF_WIDTH_MPS;
    let left = along.perp();
    [from_mps - along + left, to_mps + along + left, to_mps + along - left, from_mps - along - left]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses_are_judged_by_angle_and_by_speed() {
        let is_straight = |speed_mps: f32, aside_deg: f32| {
            let strafe_mps = speed_mps * aside_deg.to_radians();
            goes_straight(&Parameters { speed_mps, turn_rate_rad_s: 0.0, strafe_mps })
        };
        assert!(is_straight(4.0, 4.0) && !is_straight(4.0, 8.0));
        assert!(is_straight(0.5, 8.0) && !is_straight(0.5, 20.0));
        assert!(is_straight(-2.0, 4.0));
    }

    #[test]
    fn fast_turns_end_after_half_a_turn() {
        for (turn_deg_s, y_mps) in [(90.0_f32, 1.0), (170.0, 0.17), (200.0, 0.0), (-170.0, -0.17), (-300.0, 0.0)] {
            let turn_rate_rad_s = turn_deg_s.to_radians();
            let point_mps = turning_point_mps(&Parameters { speed_mps: 1.0, turn_rate_rad_s, strafe_mps: 0.0 });
            assert!((point_mps.y - y_mps).abs() < 0.01, "{turn_deg_s} °/s: {point_mps}");
        }
    }
}

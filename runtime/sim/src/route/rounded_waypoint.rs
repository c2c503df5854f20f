//! A waypoint on the way, rounded: an agent turns towards the one after as it comes near. World, metres, seconds.

use glam::Vec2;

use crate::scenario::AgentSpec;

/// Distance within which an agent beyond a waypoint has passed it, m: two agents abreast fill the path about the
/// waypoint, and a third that turned the corner beside them would otherwise come back.
const BESIDE_M: f32 = 1.0;
/// Distance aside up to which a waypoint is rounded in full, m; at [`BESIDE_M`] it is not rounded at all.
const ROUNDED_M: f32 = 0.5;
/// Time before a waypoint at which rounding begins, s: 0.9 m at a walk (docs/tuning.md).
const ROUNDING_S: f32 = 0.7;
/// Cosine of the sharpest turn that is rounded, 120°. To turn further, an agent first walks to the waypoint.
const ROUNDED_COS: f32 = -0.5;
/// Distance within which a waypoint of such a turn is reached, m: the radius of an arrival.
pub(crate) const WAYPOINT_RADIUS_M: f32 = 0.5;

/// A waypoint that is not the last one, and how it is rounded.
pub(crate) struct RoundedWaypoint {
    waypoint_m: Vec2,
    after_m: Vec2,
    /// Unit vector onwards, across the bisector of the paths to and from the waypoint; none where the turn is too sharp
    /// to be rounded.
    onwards: Option<Vec2>,
    /// Distance before the bisector at which rounding begins, m.
    rounding_m: f32,
}

impl RoundedWaypoint {
    /// A waypoint of an agent, by its index; not the last one.
    pub(crate) fn new(agent: &AgentSpec, waypoint: usize) -> Self {
        let [waypoint_m, after_m] = [agent.goals_m[waypoint], agent.goals_m[waypoint + 1]];
        let before_m = waypoint.checked_sub(1).map_or(agent.position_m, |before| agent.goals_m[before]);
        let [to, from] = [waypoint_m - before_m, after_m - waypoint_m].map(Vec2::normalize_or_zero);
        let onwards = (to + from).try_normalize().filter(|_| to.dot(from) > ROUNDED_COS);
        let rounding_m = ROUNDING_S * agent.preferred_speed_mps * onwards.map_or(0.0, |onwards| onwards.dot(to));
        Self { waypoint_m, after_m, onwards, rounding_m }
    }

    /// Whether the waypoint lies behind, and not far aside; before a sharp turn, whether it is near.
    pub(crate) fn is_passed(&self, position_m: Vec2) -> bool {
        let beyond_m = position_m - self.waypoint_m;
        match self.onwards {
            Some(onwards) => beyond_m.dot(onwards) >= 0.0 && beyond_m.length() < BESIDE_M,
            None => beyond_m.length() < WAYPOINT_RADIUS_M,
        }
    }

    /// Unit direction of v_pref: to the waypoint, turning towards the one after as the bisector comes near.
    pub(crate) fn direction(&self, position_m: Vec2) -> Vec2 {
        let [to, after] = [self.waypoint_m, self.after_m].map(|goal_m| (goal_m - position_m).normalize_or_zero());
        let Some(onwards) = self.onwards else { return to };
        let beyond_m = position_m - self.waypoint_m;
        let before_m = -beyond_m.dot(onwards);
        let near = if before_m > 0.0 { (1.0 - before_m / self.rounding_m).max(0.0) } else { 0.0 };
        let abreast = ((BESIDE_M - beyond_m.perp_dot(onwards).abs()) / (BESIDE_M - ROUNDED_M)).clamp(0.0, 1.0);
        to.lerp(after, near * abreast).normalize_or(to)
    }
}

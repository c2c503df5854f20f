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
/// Time for which a body goes on before it turns as v_pref does, s: plans lag, and bodies behind plans
/// (docs/tuning.md).
const TURNING_S: f32 = 0.3;
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

    /// Whether the turn is gentle enough to be rounded.
    pub(crate) fn is_rounded(&self) -> bool {
        self.onwards.is_some()
    }

    /// Whether the waypoint lies behind, and not far aside; before a sharp turn, whether it is near.
    pub(crate) fn is_passed(&self, position_m: Vec2) -> bool {
        let beyond_m = position_m - self.waypoint_m;
        match self.onwards {
            Some(onwards) => beyond_m.dot(onwards) >= 0.0 && beyond_m.length() < BESIDE_M,
            None => beyond_m.length() < WAYPOINT_RADIUS_M,
        }
    }

    /// Unit direction of v_pref: to the waypoint, turning towards the one after as the bisector comes near. An agent
    /// goes on at `coasting_mps` before it turns, so it counts as that much nearer.
    pub(crate) fn direction(&self, position_m: Vec2, coasting_mps: Vec2) -> Vec2 {
        let to = (self.waypoint_m - position_m).normalize_or_zero();
        let Some(onwards) = self.onwards else { return to };
        let beyond_m = position_m - self.waypoint_m;
        if beyond_m.dot(onwards) >= 0.0 {
            return to; // beyond, but far aside: back to the waypoint
        }
        let ahead_m = (TURNING_S * coasting_mps.dot(to).max(0.0)).min(beyond_m.length());
        let turning_m = position_m + ahead_m * to;
        let after = (self.after_m - turning_m).normalize_or_zero();
        let before_m = (self.waypoint_m - turning_m).dot(onwards).max(0.0);
        let near = (1.0 - before_m / self.rounding_m.max(f32::MIN_POSITIVE)).max(0.0);
        let abreast = ((BESIDE_M - beyond_m.perp_dot(onwards).abs()) / (BESIDE_M - ROUNDED_M)).clamp(0.0, 1.0);
        to.lerp(after, near * abreast).normalize_or(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A right turn at (5, 0), of an agent that comes from (0, 0) at 1.3 m/s.
    fn right_turn() -> RoundedWaypoint {
        let goals_m = vec![Vec2::new(5.0, 0.0), Vec2::new(5.0, -5.0)];
        RoundedWaypoint::new(&AgentSpec { goals_m, preferred_speed_mps: 1.3, ..AgentSpec::default() }, 0)
    }

    #[test]
    fn a_body_that_goes_on_turns_earlier() {
        let (waypoint, walk_mps) = (right_turn(), Vec2::new(1.3, 0.0));
        let turn_rad = |before_m: f32, coasting_mps: Vec2| {
            -waypoint.direction(Vec2::new(5.0 - before_m, 0.0), coasting_mps).to_angle()
        };
        assert_eq!(turn_rad(1.0, Vec2::ZERO), 0.0);
        assert!(turn_rad(1.0, walk_mps) > 0.2);
        assert!(turn_rad(0.5, walk_mps) > turn_rad(0.5, Vec2::ZERO) + 0.2);
        // Pushed back or aside it does not turn earlier.
        let pushed_mps = [-Vec2::X, Vec2::Y, -Vec2::Y];
        assert!(pushed_mps.iter().all(|&pushed_mps| turn_rad(0.5, pushed_mps) == turn_rad(0.5, Vec2::ZERO)));
    }

    #[test]
    fn a_body_walks_on_along_near_waypoints() {
        let goals_m = [0.1, 0.2, 0.3].map(|x| Vec2::new(x, 0.0)).to_vec();
        let waypoint =
            RoundedWaypoint::new(&AgentSpec { goals_m, preferred_speed_mps: 1.3, ..AgentSpec::default() }, 0);
        for x in [0.0, 0.05, 0.09] {
            assert_eq!(waypoint.direction(Vec2::new(x, 0.0), Vec2::new(1.9, 0.0)), Vec2::X, "{x} m");
        }
    }
}

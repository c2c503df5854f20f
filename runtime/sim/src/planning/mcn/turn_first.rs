//! Agents that turn before they walk (our addition to `FbCrowd` §4.5).
//!
//! People whose route leads aside or behind turn on the spot, by one or two steps, and then walk. With side-steps and steps
//! back in the database nothing in MCN makes an agent wait for its facing: it goes sideways at the speed of a shuffle while
//! it turns. So the speed of v_pref falls with the angle of the route to the facing. World axes, m/s.

use glam::Vec2;

/// Cosine of the angle up to which an agent walks at its whole speed: 60°.
const WALKING_COS: f32 = 0.5;
/// Cosine of the angle from which on it only turns: 100°.
const TURNING_COS: f32 = -0.173_648_18;
/// Share of the speed that is left: the first step of a turn leads a little along the route.
const LEAST_SHARE: f32 = 0.1;
/// Cosine of the angle to the route within which a facing leads along it: 30°.
const ALONG_COS: f32 = 0.866_025_4;

/// Share by which an agent that faces `forward` turns before it walks in a direction: 0 within 60°, 1 from 100° on.
fn turning_share(forward: Vec2, direction: Vec2) -> f32 {
    let cos = direction.try_normalize().map_or(1.0, |direction| direction.dot(forward));
    ((WALKING_COS - cos) / (WALKING_COS - TURNING_COS)).clamp(0.0, 1.0)
}

/// v_pref at the speed that turning to the route leaves to an agent that faces `forward`.
pub(crate) fn slowed_to_turn(forward: Vec2, route_mps: Vec2, preferred_mps: Vec2) -> Vec2 {
    preferred_mps * (1.0 - turning_share(forward, route_mps)).max(LEAST_SHARE)
}

/// Share by which an agent that turns to a facing does so before it walks, 0 to 1; 0 unless that facing leads along its
/// route. In a queue, where velocities jump, facings do not.
pub(crate) fn turning_along_route(forward: Vec2, facing: Vec2, route_mps: Vec2) -> f32 {
    let leads_along = route_mps.try_normalize().is_some_and(|route| route.dot(facing) >= ALONG_COS);
    if leads_along { turning_share(forward, facing) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_falls_from_60_to_100_degrees_off_the_facing() {
        let speed_mps = |angle_deg: f32| {
            let route_mps = Vec2::Y.rotate(1.3 * Vec2::from_angle(angle_deg.to_radians()));
            slowed_to_turn(Vec2::Y, route_mps, route_mps).length()
        };
        assert!([0.0, -59.0, 59.0].into_iter().all(|angle_deg| (speed_mps(angle_deg) - 1.3).abs() < 1e-5));
        assert!((speed_mps(75.0) - speed_mps(-75.0)).abs() < 1e-5 && (0.6..1.0).contains(&speed_mps(75.0)));
        assert!([101.0, 180.0, -140.0].into_iter().all(|angle_deg| (speed_mps(angle_deg) - 0.13).abs() < 1e-5));
        assert_eq!(slowed_to_turn(Vec2::X, Vec2::ZERO, Vec2::ZERO), Vec2::ZERO);
        // Off a wall, along which the route leads.
        assert_eq!(slowed_to_turn(Vec2::X, Vec2::X, Vec2::Y), Vec2::Y);
    }

    #[test]
    fn only_a_facing_along_the_route_is_turned_to_quickly() {
        let [behind, aside] = [-Vec2::X, Vec2::Y];
        assert_eq!(turning_along_route(Vec2::X, behind, 1.3 * behind), 1.0);
        assert_eq!(turning_along_route(Vec2::X, behind, aside), 0.0);
        assert_eq!(turning_along_route(Vec2::X, Vec2::from_angle(0.8), Vec2::from_angle(0.8)), 0.0);
        assert_eq!(turning_along_route(Vec2::X, behind, Vec2::ZERO), 0.0);
    }
}

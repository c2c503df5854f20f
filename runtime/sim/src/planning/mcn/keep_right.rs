//! Keeping right: v_pref turns to the right of agents that it would meet (our addition to `FbCrowd` §4.3).
//!
//! Two identical agents that meet head-on can pass on either side. They would choose alike, evade alike and meet again:
//! a circle or a corridor of exact symmetry deadlocks. A convention breaks the symmetry without chance, so mirrored
//! scenes resolve too. The turn grows with the number of agents met, and with how soon and how squarely they are met.
//! It fades towards a graze and towards the time horizon, so it does not jump when an agent enters or leaves the path.
//! World axes, metres, seconds.

use glam::Vec2;

use crate::planning::mcn::params::McnParams;
use crate::world::neighbours::neighbour_lanes::{Lanes, NeighbourLanes};

/// v_pref, turned to the right, m/s. `shares` states how much of the avoiding the agent does against each neighbour, ½
/// among equals.
pub(crate) fn kept_right(
    preferred_mps: Vec2,
    velocity_mps: Vec2,
    neighbours: &NeighbourLanes,
    shares: &Lanes,
    params: &McnParams,
) -> Vec2 {
    let change_mps = preferred_mps - velocity_mps;
    let times_s = neighbours.times_to_collision_s(change_mps);
    let squareness = squareness(neighbours, change_mps);
    let urgency =
        |lane: usize| 2.0 * shares[lane] * squareness[lane] * (1.0 - times_s[lane] / params.time_horizon_s).max(0.0);
    let urgency = (0..times_s.len()).map(urgency).sum::<f32>().min(1.0);
    let (sin, cos) = libm::sincosf(-params.keep_right_rad * urgency);
    Vec2::new(cos, sin).rotate(preferred_mps)
}

/// How squarely each neighbour would be met if the velocity changed: 1 head-on, 0 at a graze and beyond.
fn squareness(neighbours: &NeighbourLanes, change_mps: Vec2) -> Lanes {
    std::array::from_fn(|lane| {
        let relative_mps = neighbours.relative_mps(lane) + change_mps;
        let miss = neighbours.offset_m(lane).perp_dot(relative_mps) / neighbours.radius_m[lane];
        (1.0 - miss * miss / relative_mps.length_squared().max(f32::MIN_POSITIVE)).max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::neighbours::neighbour_lanes::LANES;

    /// The turn of an agent that walks along +x towards one that stands at an offset, rad.
    fn turn_rad(offset: [f32; 2]) -> f32 {
        let mut neighbours = NeighbourLanes::default();
        neighbours.set(0, Vec2::from(offset), Vec2::X, 0.5);
        kept_right(Vec2::X, Vec2::X, &neighbours, &[0.5; LANES], &McnParams::default()).to_angle()
    }

    #[test]
    fn turns_more_for_sooner_and_squarer_encounters() {
        let [near, far, aside, passed] = [[1.0, 0.0], [3.0, 0.0], [1.0, 0.4], [1.0, 0.6]].map(turn_rad);
        assert!(near < far && far < 0.0 && near < aside && aside < 0.0);
        assert_eq!(passed, 0.0);
        assert_eq!(turn_rad([1.0, 0.4]), turn_rad([1.0, -0.4]));
    }

    #[test]
    fn turn_is_continuous_when_agent_enters_path() {
        for (grazes, misses) in [([1.0, 0.499], [1.0, 0.501]), ([4.49, 0.0], [4.51, 0.0])] {
            assert!((turn_rad(grazes) - turn_rad(misses)).abs() < 2e-3);
        }
    }
}

//! Everybody gives way to the right: v_pref turns there the more, the sooner, the more squarely and the more people it
//! would meet.
//!
//! Whoever is met head-on can be passed on either side, and two who are alike would choose alike, dodge alike and meet
//! again: a circle or a corridor of exact symmetry deadlocks. A convention breaks the symmetry without chance, so
//! mirrored scenes resolve too. The turn fades towards a graze, where the side is clear, and with the time left, so it
//! does not jump when somebody comes into the way or leaves it. World axes, metres, seconds.

use glam::Vec2;

use crate::planning::mcn::params::McnParams;
use crate::world::neighbour_lanes::{Around, Lanes};

/// v_pref, turned.
pub(crate) fn kept_right(preferred_mps: Vec2, velocity_mps: Vec2, around: &Around, params: &McnParams) -> Vec2 {
    let change_mps = preferred_mps - velocity_mps;
    let times_s = around.times_to_collision_s(change_mps);
    let squareness = squareness(around, change_mps);
    let urgency = |lane: usize| squareness[lane] * (1.0 - times_s[lane] / params.time_horizon_s).max(0.0);
    let urgency = (0..times_s.len()).map(urgency).sum::<f32>().min(1.0);
    let (sin, cos) = libm::sincosf(-params.keep_right_rad * urgency);
    Vec2::new(cos, sin).rotate(preferred_mps)
}

/// How squarely each would be met, were the velocity changed: 1 head-on, 0 at a graze and beyond.
fn squareness(around: &Around, change_mps: Vec2) -> Lanes {
    std::array::from_fn(|lane| {
        let velocity_mps = around.velocity_mps(lane) + change_mps;
        let miss = around.offset_m(lane).perp_dot(velocity_mps) / around.radius_m[lane];
        (1.0 - miss * miss / velocity_mps.length_squared().max(f32::MIN_POSITIVE)).max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The turn of a walker along +x that meets one who stands at `offset`, rad.
    fn turn_rad(offset: [f32; 2]) -> f32 {
        let mut around = Around::default();
        around.put(0, Vec2::from(offset), Vec2::X, 0.5);
        kept_right(Vec2::X, Vec2::X, &around, &McnParams::default()).to_angle()
    }

    #[test]
    fn turns_to_the_right_the_more_the_sooner_and_the_more_squarely() {
        let [near, far, aside, passed] = [[1.0, 0.0], [3.0, 0.0], [1.0, 0.4], [1.0, 0.6]].map(turn_rad);
        assert!(near < far && far < 0.0 && near < aside && aside < 0.0);
        assert_eq!(passed, 0.0);
        assert_eq!(turn_rad([1.0, 0.4]), turn_rad([1.0, -0.4]));
    }

    #[test]
    fn nothing_jumps_where_somebody_comes_into_the_way() {
        for (grazes, misses) in [([1.0, 0.499], [1.0, 0.501]), ([4.49, 0.0], [4.51, 0.0])] {
            assert!((turn_rad(grazes) - turn_rad(misses)).abs() < 2e-3);
        }
    }
}

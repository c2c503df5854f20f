//! Slowing: in the half-planes of both agents, an agent that brakes before a goal, or wants to stand, counts as slower.
//! `FbCrowd` does not have it.
//!
//! By equal shares, an agent with another close behind can hardly brake: of the speed gap/τ at which both may close, it
//! has one half. So agents that came to one place together ran on past their goals. Agents that stood were pushed along
//! by those that passed: an agent that moves counts as one that walks on. People see each other brake, and step around
//! people who stand.
//!
//! With the velocity v of an agent after its right of way, and the speed s that it prefers on a free path, it gains
//!
//! ```text
//! max(0, 1 - |v_pref|/s) · clamp((|v| - |v_pref|)/D, 0, 1) · (v_pref - v),  at most L.
//! ```
//!
//! The first factor is 1 where the agent wants to stand, and 0 where it wants to walk at its own speed. In a state, a
//! group or a zone that slows an agent down, it is between both (docs/tuning.md).
//!
//! World axes, m/s.

use glam::Vec2;

use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;

/// D: speed beyond that of v_pref from which the gain is whole, m/s.
const EXCESS_MPS: f32 = 0.2;
/// L: most that an agent gains, m/s: what a body loses within .3 s at 3 m/s².
const GAIN_MAX_MPS: f32 = 0.9;

/// An agent's velocity, and one of its neighbours, with what both gain by slowing.
pub(crate) fn with_slowing(world: &WorldView, agent: usize, own_mps: Vec2, neighbour: &Neighbour) -> (Vec2, Neighbour) {
    let gain_mps = |agent: usize, velocity_mps: Vec2| {
        gain_mps(velocity_mps, world.preferred_mps[agent], world.free_speeds_mps[agent])
    };
    let own_gain_mps = gain_mps(agent, own_mps);
    let other_gain_mps = gain_mps(neighbour.agent as usize, own_mps - neighbour.relative_mps);
    (own_mps + own_gain_mps, neighbour.with_gains(own_gain_mps, other_gain_mps))
}

/// What an agent gains that prefers a speed on a free path.
// Inlined, and without a square root where there is no gain: planning takes 8 % less.
#[inline(always)]
fn gain_mps(velocity_mps: Vec2, preferred_mps: Vec2, free_speed_mps: f32) -> Vec2 {
    let preferred_squared = preferred_mps.length_squared();
    if preferred_squared >= free_speed_mps * free_speed_mps || velocity_mps.length_squared() <= preferred_squared {
        return Vec2::ZERO;
    }
    let preferred_speed_mps = preferred_squared.sqrt();
    let wants_rest = 1.0 - preferred_speed_mps / free_speed_mps;
    let excess_share = ((velocity_mps.length() - preferred_speed_mps) / EXCESS_MPS).min(1.0);
    (wants_rest * excess_share * (preferred_mps - velocity_mps)).clamp_length_max(GAIN_MAX_MPS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_agent_that_wants_to_stand_counts_as_standing() {
        for velocity_mps in [Vec2::new(0.8, 0.0), Vec2::new(0.0, -0.2)] {
            assert_eq!(velocity_mps + gain_mps(velocity_mps, Vec2::ZERO, 1.3), Vec2::ZERO);
        }
    }

    #[test]
    fn an_agent_that_halts_suddenly_counts_as_moving_on() {
        let counted_mps = 1.7 * Vec2::X + gain_mps(1.7 * Vec2::X, Vec2::ZERO, 1.3);
        assert!(counted_mps.distance(0.8 * Vec2::X) < 1e-6, "{counted_mps}");
    }

    #[test]
    fn an_agent_that_brakes_counts_as_slower() {
        let counted_mps = Vec2::X + gain_mps(Vec2::X, 0.5 * Vec2::X, 1.3);
        assert!(counted_mps.y == 0.0 && (0.65..0.75).contains(&counted_mps.x), "{counted_mps}");
    }

    #[test]
    fn an_agent_that_walks_or_speeds_up_counts_as_it_moves() {
        for (velocity_mps, preferred_mps) in [(1.7 * Vec2::X, 1.3 * Vec2::Y), (0.3 * Vec2::X, 0.6 * Vec2::Y)] {
            assert_eq!(gain_mps(velocity_mps, preferred_mps, 1.3), Vec2::ZERO);
        }
    }
}

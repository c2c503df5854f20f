//! Pressing: agents that stand in contact, and want to go in different directions, press on. `FbCrowd` does not have
//! it.
//!
//! By equal shares, each of two agents in contact moves towards the other no faster than the mean of both velocities
//! along the line of their centres. Where both stand, this mean is zero and stays zero, so three agents that form an
//! arch before a door would stand for ever. So an agent at rest counts as if it had already gained a part of what it
//! lacks of v_pref. The mean then moves towards the agent that gains less along the line, and this agent gives way.
//!
//! With the velocity v_i of agent i after its right of way and its slowing, the direction e_i of its preferred velocity
//! (zero where it prefers to stand), a factor r_i of rest, which falls from 1 to 0 at the speed V, and a factor n of
//! nearness, which falls from 1 in contact to 0 at the gap D, agent i gains against its neighbour j
//!
//! ```text
//! n · min(1, |e_i - e_j|²) · r_i · (v_pref_i - v_i),  the last factor limited to P.
//! ```
//!
//! The first two factors are the *conflict* of both agents.
//!
//! Agents that queue prefer the same direction, and do not press: in a full hall their pressure would add up. Agents
//! that prefer to stand are pressed, so that others get past them (docs/tuning.md).
//!
//! World axes, metres, m/s.

use glam::Vec2;

use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;

/// P: most that an agent gains, m/s.
const GAIN_MAX_MPS: f32 = 0.2;
/// V: speed from which an agent does not press, m/s.
const MOVING_MPS: f32 = 0.3;
/// D: gap between two discs from which their agents do not press, m.
const GAP_MAX_M: f32 = 0.1;

/// An agent's velocity, and one of its neighbours, with what both gain by pressing.
pub(crate) fn with_pressing(
    world: &WorldView,
    agent: usize,
    own_mps: Vec2,
    neighbour: &Neighbour,
) -> (Vec2, Neighbour) {
    let conflict = conflict(world, agent, neighbour);
    if conflict <= 0.0 {
        return (own_mps, *neighbour);
    }
    let other = neighbour.agent as usize;
    let gain_mps = |agent: usize, velocity_mps: Vec2| {
        let rest = (1.0 - velocity_mps.length() / MOVING_MPS).max(0.0);
        conflict * rest * (world.preferred_mps[agent] - velocity_mps).clamp_length_max(GAIN_MAX_MPS)
    };
    let own_gain_mps = gain_mps(agent, own_mps);
    let other_gain_mps = gain_mps(other, own_mps - neighbour.relative_mps);
    (own_mps + own_gain_mps, neighbour.with_gains(own_gain_mps, other_gain_mps))
}

/// max_j n · min(1, |e_i - e_j|²): the greatest conflict of an agent with a neighbour near by, 0 to 1.
pub(crate) fn greatest_conflict(world: &WorldView, agent: usize, neighbours: &[Neighbour]) -> f32 {
    neighbours.iter().map(|neighbour| conflict(world, agent, neighbour)).fold(0.0, f32::max)
}

/// n · min(1, |e_i - e_j|²): how near a neighbour is that prefers another direction, 0 to 1.
fn conflict(world: &WorldView, agent: usize, neighbour: &Neighbour) -> f32 {
    let nearness = 1.0 - (neighbour.distance_m - neighbour.radius_m).max(0.0) / GAP_MAX_M;
    if nearness <= 0.0 {
        return 0.0;
    }
    let [own, other] = [agent, neighbour.agent as usize].map(|agent| world.preferred_direction(agent));
    nearness * own.distance_squared(other).min(1.0)
}

//! One neighbour of an agent, the query that finds neighbours, and how many are taken.
//!
//! World axes, metres, seconds. Agent i searches and agent j is found; p, v and r are position, velocity and radius.

use glam::Vec2;

/// Neighbours that an agent takes into account: as many as in RVO2's examples (van den Berg et al. 2011).
pub const NEIGHBOUR_COUNT: usize = 10;
/// T: time ahead within which MCN ranks neighbours, s. Among 0.5, 1, 1.2 and 1.5 s, A was least with 1.5 s for a
/// hundred agents that cross 0.8 m and 1 m apart.
pub(crate) const RANKING_HORIZON_S: f32 = 1.5;

/// One neighbour found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Index j of the neighbour.
    pub agent: u32,
    /// Offset to the neighbour, p_j − p_i, m.
    pub offset_m: Vec2,
    /// Relative velocity that closes the offset, v_i − v_j, m/s.
    pub relative_mps: Vec2,
    /// Sum of both radii, r_i + r_j, m.
    pub radius_m: f32,
    /// Distance of the centres, m.
    pub distance_m: f32,
    /// Time to collision of the discs at their present velocities, s; infinite where they do not meet, 0 in overlap.
    pub time_to_collision_s: f32,
}

impl Neighbour {
    /// The neighbour, where both agents count as if they had gained velocities, m/s. The time to collision stays.
    pub(crate) fn with_gains(&self, own_gain_mps: Vec2, other_gain_mps: Vec2) -> Self {
        Self { relative_mps: self.relative_mps + own_gain_mps - other_gain_mps, ..*self }
    }
}

/// The agent that searches.
#[derive(Clone, Copy, Debug)]
pub struct NeighbourQuery {
    /// Index i of the agent; it is not its own neighbour.
    pub agent: usize,
    /// p_i: centre of the search, world, m.
    pub position_m: Vec2,
    /// v_i: for ranks and times to collision, world, m/s.
    pub velocity_mps: Vec2,
    /// r_i: for times to collision, m.
    pub radius_m: f32,
    /// Farthest distance of a neighbour, m.
    pub range_m: f32,
}

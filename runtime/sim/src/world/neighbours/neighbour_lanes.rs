//! An agent's neighbours as a structure of arrays, for kernels that treat all of them at once.
//!
//! The arrays are as long as [`NEIGHBOUR_COUNT`] rounded up to whole vectors. A lane without a neighbour lies
//! infinitely far away. Loops over all lanes have no branch, so the compiler turns them into vector instructions on
//! every machine, and each lane gets the bits of the scalar formula. World axes, metres, seconds.

use glam::Vec2;

use crate::world::neighbours::neighbour::{NEIGHBOUR_COUNT, Neighbour};
use crate::world::time_to_collision::disc_with_disc;

/// Number of lanes: [`NEIGHBOUR_COUNT`] in whole vectors of four.
pub(crate) const LANES: usize = NEIGHBOUR_COUNT.next_multiple_of(4);

/// One value per neighbour.
pub type Lanes = [f32; LANES];

/// The neighbours j of an agent i, best rank first.
#[derive(Clone, Copy, Debug)]
pub struct NeighbourLanes {
    /// x of the offset p_j − p_i, m.
    pub x_m: Lanes,
    /// y of the offset p_j − p_i, m.
    pub y_m: Lanes,
    /// x of the relative velocity v_i − v_j, m/s.
    pub relative_x_mps: Lanes,
    /// y of the relative velocity v_i − v_j, m/s.
    pub relative_y_mps: Lanes,
    /// Sum of both radii, r_i + r_j, m.
    pub radius_m: Lanes,
}

impl Default for NeighbourLanes {
    /// No neighbours.
    fn default() -> Self {
        let none = [0.0; LANES];
        Self { x_m: [f32::INFINITY; LANES], y_m: none, relative_x_mps: none, relative_y_mps: none, radius_m: none }
    }
}

impl NeighbourLanes {
    /// Sets a lane: p_j − p_i, v_i − v_j and r_i + r_j.
    pub fn set(&mut self, lane: usize, offset_m: Vec2, relative_mps: Vec2, radius_m: f32) {
        (self.x_m[lane], self.y_m[lane]) = offset_m.into();
        (self.relative_x_mps[lane], self.relative_y_mps[lane]) = relative_mps.into();
        self.radius_m[lane] = radius_m;
    }

    /// p_j − p_i of a lane, m.
    #[inline]
    pub fn offset_m(&self, lane: usize) -> Vec2 {
        Vec2::new(self.x_m[lane], self.y_m[lane])
    }

    /// v_i − v_j of a lane, m/s.
    #[inline]
    pub fn relative_mps(&self, lane: usize) -> Vec2 {
        Vec2::new(self.relative_x_mps[lane], self.relative_y_mps[lane])
    }

    /// A lane as one neighbour, given its index and time to collision.
    pub(crate) fn neighbour(&self, lane: usize, agent: u32, time_to_collision_s: f32) -> Neighbour {
        let offset_m = self.offset_m(lane);
        Neighbour {
            agent,
            offset_m,
            relative_mps: self.relative_mps(lane),
            radius_m: self.radius_m[lane],
            distance_m: offset_m.length_squared().sqrt(),
            time_to_collision_s,
        }
    }

    /// Times to collision if v_i changed by `change_mps`, s; infinite where the discs do not meet.
    pub fn times_to_collision_s(&self, change_mps: Vec2) -> Lanes {
        std::array::from_fn(|lane| {
            disc_with_disc(self.offset_m(lane), self.relative_mps(lane) + change_mps, self.radius_m[lane])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_lane_is_never_met() {
        let mut lanes = NeighbourLanes::default();
        for change_mps in [Vec2::ZERO, Vec2::X, Vec2::new(1e4, -1e4)] {
            assert_eq!(lanes.times_to_collision_s(change_mps), [f32::INFINITY; LANES]);
        }
        lanes.set(3, Vec2::new(2.0, 0.0), Vec2::ZERO, 0.5);
        let times_s = lanes.times_to_collision_s(Vec2::new(3.0, 0.0));
        assert_eq!((times_s[2], times_s[3]), (f32::INFINITY, 0.5));
    }
}

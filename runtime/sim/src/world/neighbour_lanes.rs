//! An agent's neighbours as a structure of arrays, for kernels that treat all of them at once.
//!
//! The arrays are as long as the number of neighbours rounded up to whole vectors; lanes without a neighbour lie
//! infinitely far away. Loops over all lanes have no branch, so the compiler makes vector instructions of them on every
//! machine, and each gives the bits of the scalar formula. World axes, metres, seconds.

use glam::Vec2;

use crate::world::neighbours::{NEIGHBOUR_COUNT, Neighbour};
use crate::world::time_to_collision::disc_with_disc;

/// [`NEIGHBOUR_COUNT`] in whole vectors of four.
pub(crate) const LANES: usize = NEIGHBOUR_COUNT.next_multiple_of(4);

/// One figure of every neighbour.
pub type Lanes = [f32; LANES];

/// The neighbours of agent i.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// p_j − p_i.
    pub x_m: Lanes,
    /// p_j − p_i.
    pub y_m: Lanes,
    /// v_i − v_j.
    pub velocity_x_mps: Lanes,
    /// v_i − v_j.
    pub velocity_y_mps: Lanes,
    /// r_i + r_j.
    pub radius_m: Lanes,
}

impl Default for Around {
    fn default() -> Self {
        let none = [0.0; LANES];
        Self { x_m: [f32::INFINITY; LANES], y_m: none, velocity_x_mps: none, velocity_y_mps: none, radius_m: none }
    }
}

impl Around {
    /// Sets a lane.
    pub fn put(&mut self, lane: usize, offset_m: Vec2, velocity_mps: Vec2, radius_m: f32) {
        (self.x_m[lane], self.y_m[lane]) = offset_m.into();
        (self.velocity_x_mps[lane], self.velocity_y_mps[lane]) = velocity_mps.into();
        self.radius_m[lane] = radius_m;
    }

    /// p_j − p_i of a lane.
    #[inline]
    pub fn offset_m(&self, lane: usize) -> Vec2 {
        Vec2::new(self.x_m[lane], self.y_m[lane])
    }

    /// v_i − v_j of a lane.
    #[inline]
    pub fn velocity_mps(&self, lane: usize) -> Vec2 {
        Vec2::new(self.velocity_x_mps[lane], self.velocity_y_mps[lane])
    }

    /// A lane as one neighbour, met after a time.
    pub(crate) fn neighbour(&self, lane: usize, agent: u32, time_to_collision_s: f32) -> Neighbour {
        let offset_m = self.offset_m(lane);
        Neighbour {
            agent,
            offset_m,
            velocity_mps: self.velocity_mps(lane),
            radius_m: self.radius_m[lane],
            distance_m: offset_m.length_squared().sqrt(),
            time_to_collision_s,
        }
    }

    /// Times to collision, were i's velocity changed by `change`, s; infinite where nobody is met.
    pub fn times_to_collision_s(&self, change_mps: Vec2) -> Lanes {
        std::array::from_fn(|lane| {
            disc_with_disc(self.offset_m(lane), self.velocity_mps(lane) + change_mps, self.radius_m[lane])
        })
    }

    /// The least of them.
    pub fn time_to_collision_s(&self, change_mps: Vec2) -> f32 {
        self.times_to_collision_s(change_mps).into_iter().fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_met_in_an_empty_lane() {
        let mut around = Around::default();
        for change_mps in [Vec2::ZERO, Vec2::X, Vec2::new(1e4, -1e4)] {
            assert_eq!(around.time_to_collision_s(change_mps), f32::INFINITY);
        }
        around.put(3, Vec2::new(2.0, 0.0), Vec2::ZERO, 0.5);
        assert_eq!(around.time_to_collision_s(Vec2::new(3.0, 0.0)), 0.5);
    }
}

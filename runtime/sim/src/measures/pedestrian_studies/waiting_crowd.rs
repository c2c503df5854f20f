//! The shape of a crowd that waits before a door: real crowds form a half-circle about it (arching, `FbCrowd` §7).
//!
//! The floor before the door is divided into equal sectors. Agents that fill a sector evenly up to a radius R are 2R/3
//! away on average, so a sector's mean distance gives how far the crowd reaches in it. In a half-circle all sectors
//! reach equally far; in a queue one reaches far and the others not at all. Rings about the door give the density.
//! World, metres, seconds.

use std::f32::consts::PI;

use glam::Vec2;

/// Sectors of the half-circle: 30° each, in which a dense crowd of 2 m has at least an agent in every other frame.
pub const SECTORS: usize = 6;
/// Number of rings about the door.
const RINGS: usize = 4;
/// Width of a ring, m.
const RING_M: f32 = 1.0;
/// Speed below which an agent waits, m/s: that at 2.3 people/m² (Weidmann 1993), beyond the densities that flow freely
/// (Fruin's level of service E begins at 1.1 to 2.2).
const WAITING_MPS: f32 = 0.5;
/// Distance from the door beyond which no agent counts, m.
const REACH_M: f32 = 6.0;

/// A door and the agents that waited before it, counted frame by frame.
#[derive(Clone, Debug)]
pub struct WaitingCrowd {
    door_m: Vec2,
    /// Unit vector from the door into the crowd.
    before: Vec2,
    frames: usize,
    /// Number of waiting agents and the sum of their distances, by sector.
    sectors: [(usize, f64); SECTORS],
    /// Number of agents, waiting or not, by ring.
    rings: [usize; RINGS],
}

/// The shape of a waiting crowd: means over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaitingShape {
    /// Number of agents that wait.
    pub waiting: f64,
    /// Reach of the crowd in each sector, from left to right as it faces the door, m; 0 where no agent waits.
    pub reach_m: [f64; SECTORS],
    /// Density of all agents, waiting or not, ring by ring from the door, 1/m².
    pub rings_per_m2: [f64; RINGS],
}

impl WaitingShape {
    /// Radius of the best-fitting half-circle, m.
    pub fn radius_m(&self) -> f64 {
        self.reach_m.iter().sum::<f64>() / SECTORS as f64
    }

    /// Standard deviation of the reach, divided by its mean: 0 of a half-circle, √5 of a queue in one sector. None
    /// where no agent waits.
    pub fn unevenness(&self) -> Option<f64> {
        let radius_m = self.radius_m();
        let squares = self.reach_m.iter().map(|reach_m| (reach_m - radius_m) * (reach_m - radius_m)).sum::<f64>();
        (radius_m > 0.0).then(|| libm::sqrt(squares / SECTORS as f64) / radius_m)
    }
}

impl WaitingCrowd {
    /// No frames yet; `before` is the unit vector from the door into the crowd.
    pub fn new(door_m: Vec2, before: Vec2) -> Self {
        Self { door_m, before, frames: 0, sectors: [(0, 0.0); SECTORS], rings: [0; RINGS] }
    }

    /// Adds one step, given every root before and after it; NaN where an agent is not present.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2], dt_s: f32) {
        self.frames += 1;
        for (&from_m, &to_m) in before_m.iter().zip(after_m) {
            let offset_m = to_m - self.door_m;
            // In the door's frame: x into the crowd.
            let from_door_m = Vec2::new(self.before.dot(offset_m), self.before.perp_dot(offset_m));
            let distance_m = from_door_m.length();
            let is_before = from_door_m.x >= 0.0 && distance_m <= REACH_M;
            if !is_before {
                continue;
            }
            if let Some(agents) = self.rings.get_mut((distance_m / RING_M) as usize) {
                *agents += 1;
            }
            if from_m.distance(to_m) < WAITING_MPS * dt_s {
                let turn = libm::atan2f(from_door_m.y, from_door_m.x) / PI + 0.5;
                let (agents, distances_m) = &mut self.sectors[((turn * SECTORS as f32) as usize).min(SECTORS - 1)];
                *agents += 1;
                *distances_m += f64::from(distance_m);
            }
        }
    }

    /// The shape over all frames so far.
    pub fn shape(&self) -> WaitingShape {
        let frames = self.frames.max(1) as f64;
        let ring_m2 = |ring: usize| f64::from(0.5 * PI * RING_M * RING_M) * (2 * ring + 1) as f64;
        WaitingShape {
            waiting: self.sectors.iter().map(|(agents, _)| *agents as f64).sum::<f64>() / frames,
            reach_m: self.sectors.map(|(agents, distances_m)| 1.5 * distances_m / agents.max(1) as f64),
            rings_per_m2: std::array::from_fn(|ring| self.rings[ring] as f64 / frames / ring_m2(ring)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shape of a lattice of agents, at the offsets from the door at (2, 1) for which `is_crowd` holds; the door
    /// leads to +y.
    fn shape(is_crowd: impl Fn(Vec2) -> bool, moved_m: Vec2) -> WaitingShape {
        let offsets_m =
            (-60..60).flat_map(|x| (0..60).map(move |y| 0.1 * Vec2::new(x as f32 + 0.5, -(y as f32) - 0.5)));
        let door_m = Vec2::new(2.0, 1.0);
        let crowd_m: Vec<Vec2> =
            offsets_m.filter(|&offset_m| is_crowd(offset_m)).map(|offset_m| door_m + offset_m).collect();
        let before_m: Vec<Vec2> = crowd_m.iter().map(|&position_m| position_m - moved_m).collect();
        let mut waiting = WaitingCrowd::new(door_m, Vec2::NEG_Y);
        waiting.push(&before_m, &crowd_m, 0.1);
        waiting.shape()
    }

    #[test]
    fn a_half_circle_has_its_radius_and_density() {
        let shape = shape(|offset_m| offset_m.length() < 3.0, Vec2::ZERO);
        assert!((shape.radius_m() - 3.0).abs() < 0.05 && shape.unevenness().unwrap() < 0.02, "{shape:?}");
        assert!((shape.waiting / 1414.0 - 1.0).abs() < 0.01, "{shape:?}");
        assert!(shape.rings_per_m2[..3].iter().all(|per_m2| (per_m2 / 100.0 - 1.0).abs() < 0.03), "{shape:?}");
        assert!(shape.rings_per_m2[3] < 1.0, "{shape:?}");
    }

    #[test]
    fn a_queue_is_uneven_and_lies_in_its_sector() {
        let aside = |offset_m: Vec2| offset_m.length() < 3.0 && offset_m.x > 0.0 && offset_m.y > -0.5 * offset_m.x;
        // To an agent that faces the door, +x is on the right.
        let shape = shape(aside, Vec2::ZERO);
        assert!(shape.unevenness().unwrap() > 2.0 && shape.reach_m[0] == 0.0 && shape.reach_m[5] > 2.9, "{shape:?}");
    }

    #[test]
    fn an_agent_that_has_left_counts_nowhere() {
        let mut waiting = WaitingCrowd::new(Vec2::ZERO, Vec2::NEG_Y);
        waiting.push(&[Vec2::NAN, Vec2::NEG_Y], &[Vec2::NAN, Vec2::NAN], 0.1);
        assert_eq!(waiting.shape(), WaitingShape::default());
    }

    #[test]
    fn an_agent_that_walks_does_not_wait() {
        let shape = shape(|offset_m| offset_m.length() < 3.0, Vec2::new(0.0, 0.06));
        assert_eq!((shape.waiting, shape.unevenness()), (0.0, None));
        assert!(shape.rings_per_m2[0] > 90.0);
    }
}

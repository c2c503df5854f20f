//! The shape of a crowd that waits before a door: does it stand in half a circle about it, as people do?
//!
//! The floor before the door is cut into equal sectors. People who fill a sector evenly up to a radius R stand 2R/3
//! away on average, so each sector's mean distance tells how far the crowd reaches in it; of a half-circle all reach
//! equally far, of a queue one reaches far and the rest not at all. Rings about the door tell how closely people stand.
//! World, metres, seconds.

use std::f32::consts::PI;

use glam::Vec2;

/// Sectors of the half-circle: 30° each, in which a dense crowd of 2 m has at least a person in each frame or two.
pub const SECTORS: usize = 6;
/// Rings, and how wide each is, m.
pub(crate) const RINGS: usize = 4;
/// See [`RINGS`].
pub(crate) const RING_M: f32 = 1.0;
/// Slower than this somebody waits, m/s: the speed at 2.3 people/m² (Weidmann 1993), beyond the densities that still
/// flow freely (Fruin's level of service E begins at 1.1 to 2.2).
pub(crate) const WAITING_MPS: f32 = 0.5;
/// Nobody farther away waits for this door, m.
const REACH_M: f32 = 6.0;

/// A door and who waited before it.
#[derive(Clone, Debug)]
pub struct WaitingCrowd {
    door_m: Vec2,
    /// Unit vector from the door to whoever waits.
    before: Vec2,
    frames: usize,
    /// People and the sum of their distances, by sector.
    sectors: [(usize, f64); SECTORS],
    /// People, waiting or not, by ring.
    rings: [usize; RINGS],
}

/// Means over the frames seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// People who wait.
    pub waiting: f64,
    /// How far they reach in each sector, from left to right as they face the door, m; 0 where nobody waits.
    pub reach_m: [f64; SECTORS],
    /// Density of everybody, waiting or not, ring by ring from the door, 1/m².
    pub rings_per_m2: [f64; RINGS],
}

impl Shape {
    /// Radius of the half-circle that comes nearest, m.
    pub fn radius_m(&self) -> f64 {
        self.reach_m.iter().sum::<f64>() / SECTORS as f64
    }

    /// Standard deviation of the reach over its mean: 0 of a half-circle, √5 of a queue in one sector. None where
    /// nobody waits.
    pub fn unevenness(&self) -> Option<f64> {
        let radius_m = self.radius_m();
        let squares = self.reach_m.iter().map(|reach_m| (reach_m - radius_m) * (reach_m - radius_m)).sum::<f64>();
        (radius_m > 0.0).then(|| libm::sqrt(squares / SECTORS as f64) / radius_m)
    }
}

impl WaitingCrowd {
    /// `before`: unit vector from the door to whoever waits.
    pub fn new(door_m: Vec2, before: Vec2) -> Self {
        Self { door_m, before, frames: 0, sectors: [(0, 0.0); SECTORS], rings: [0; RINGS] }
    }

    /// Adds one step, given every root before and after it.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2], dt_s: f32) {
        self.frames += 1;
        for (&from_m, &to_m) in before_m.iter().zip(after_m) {
            let offset_m = to_m - self.door_m;
            // In the door's frame: x into the crowd.
            let from_door_m = Vec2::new(self.before.dot(offset_m), self.before.perp_dot(offset_m));
            let distance_m = from_door_m.length();
            if from_door_m.x < 0.0 || distance_m > REACH_M {
                continue;
            }
            if let Some(people) = self.rings.get_mut((distance_m / RING_M) as usize) {
                *people += 1;
            }
            if from_m.distance(to_m) < WAITING_MPS * dt_s {
                let turned = libm::atan2f(from_door_m.y, from_door_m.x) / PI + 0.5;
                let (people, distances_m) = &mut self.sectors[((turned * SECTORS as f32) as usize).min(SECTORS - 1)];
                *people += 1;
                *distances_m += f64::from(distance_m);
            }
        }
    }

    /// Over all frames so far.
    pub fn shape(&self) -> Shape {
        let frames = self.frames.max(1) as f64;
        let ring_m2 = |ring: usize| f64::from(0.5 * PI * RING_M * RING_M) * (2 * ring + 1) as f64;
        Shape {
            waiting: self.sectors.iter().map(|(people, _)| *people as f64).sum::<f64>() / frames,
            reach_m: self.sectors.map(|(people, distances_m)| 1.5 * distances_m / people.max(1) as f64),
            rings_per_m2: std::array::from_fn(|ring| self.rings[ring] as f64 / frames / ring_m2(ring)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice of people who stand where something holds, before a door at (2, 1) that is left in +y.
    fn shape(stand: impl Fn(Vec2) -> bool, walked_m: Vec2) -> Shape {
        let places = (-60..60).flat_map(|x| (0..60).map(move |y| 0.1 * Vec2::new(x as f32 + 0.5, -(y as f32) - 0.5)));
        let door_m = Vec2::new(2.0, 1.0);
        let crowd_m: Vec<Vec2> = places.filter(|&place_m| stand(place_m)).map(|place_m| door_m + place_m).collect();
        let before_m: Vec<Vec2> = crowd_m.iter().map(|&place_m| place_m - walked_m).collect();
        let mut waiting = WaitingCrowd::new(door_m, Vec2::NEG_Y);
        waiting.push(&before_m, &crowd_m, 0.1);
        waiting.shape()
    }

    #[test]
    fn half_a_circle_is_even_and_has_its_radius_and_density() {
        let shape = shape(|place_m| place_m.length() < 3.0, Vec2::ZERO);
        assert!((shape.radius_m() - 3.0).abs() < 0.05 && shape.unevenness().unwrap() < 0.02, "{shape:?}");
        assert!((shape.waiting / 1414.0 - 1.0).abs() < 0.01, "{shape:?}");
        assert!(shape.rings_per_m2[..3].iter().all(|per_m2| (per_m2 / 100.0 - 1.0).abs() < 0.03), "{shape:?}");
        assert!(shape.rings_per_m2[3] < 1.0, "{shape:?}");
    }

    #[test]
    fn a_queue_is_as_uneven_as_can_be_and_lies_where_it_stands() {
        let aside = |place_m: Vec2| place_m.length() < 3.0 && place_m.x > 0.0 && place_m.y > -0.5 * place_m.x;
        // To whoever faces the door, +x is on the right.
        let shape = shape(aside, Vec2::ZERO);
        assert!(shape.unevenness().unwrap() > 2.0 && shape.reach_m[0] == 0.0 && shape.reach_m[5] > 2.9, "{shape:?}");
    }

    #[test]
    fn who_walks_does_not_wait() {
        let shape = shape(|place_m| place_m.length() < 3.0, Vec2::new(0.0, 0.06));
        assert_eq!((shape.waiting, shape.unevenness()), (0.0, None));
        assert!(shape.rings_per_m2[0] > 90.0);
    }
}

//! Density and speed of whoever is in a rectangle of the floor, and Weidmann's fundamental diagram to compare them
//! with.
//!
//! The classical measurement: density is the number of people in the section over its area, speed the mean of theirs
//! along the corridor; both averaged over the frames in which somebody is there, each weighted by how many. World,
//! metres, seconds.

use glam::Vec2;

/// Weidmann 1993, "Transporttechnik der Fussgänger": free speed, m/s …
const FREE_MPS: f64 = 1.34;
/// … the fit's constant, 1/m² …
const FIT_PER_M2: f64 = 1.913;
/// … and the density at which nobody moves, 1/m².
const STANDSTILL_PER_M2: f64 = 5.4;

/// Speed at a density of people who all go one way on the level (Weidmann 1993), m/s.
pub fn weidmann_mps(per_m2: f64) -> f64 {
    if per_m2 <= 0.0 {
        return FREE_MPS;
    }
    let below_standstill = (1.0 / per_m2 - 1.0 / STANDSTILL_PER_M2).max(0.0);
    FREE_MPS * (1.0 - libm::exp(-FIT_PER_M2 * below_standstill))
}

/// A rectangle and what has been seen in it.
#[derive(Clone, Debug)]
pub struct MeasuredSection {
    low_m: Vec2,
    high_m: Vec2,
    people: usize,
    people_squared: usize,
    speeds_mps: f64,
}

/// What was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// People on a square metre.
    pub per_m2: f64,
    /// Mean speed in +x.
    pub speed_mps: f64,
}

impl MeasuredSection {
    /// Sides along the axes; people walk in +x.
    pub fn new(low_m: Vec2, high_m: Vec2) -> Self {
        Self { low_m, high_m, people: 0, people_squared: 0, speeds_mps: 0.0 }
    }

    /// Adds one step, given every root before and after it.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2], dt_s: f64) {
        let is_inside = |at_m: Vec2| at_m.cmpge(self.low_m).all() && at_m.cmplt(self.high_m).all();
        let mut people = 0;
        for (from_m, to_m) in before_m.iter().zip(after_m).filter(|(_, to_m)| is_inside(**to_m)) {
            people += 1;
            self.speeds_mps += f64::from(to_m.x - from_m.x) / dt_s;
        }
        self.people += people;
        self.people_squared += people * people;
    }

    /// None where nobody came by.
    pub fn seen(&self) -> Option<Seen> {
        let area_m2 = f64::from((self.high_m - self.low_m).element_product());
        (self.people > 0).then(|| Seen {
            per_m2: self.people_squared as f64 / self.people as f64 / area_m2,
            speed_mps: self.speeds_mps / self.people as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sees_the_density_and_speed_of_a_lattice_that_walks_by() {
        let mut section = MeasuredSection::new(Vec2::new(0.0, -1.0), Vec2::new(4.0, 1.0));
        let lattice_m = |walked_m: f32| -> Vec<Vec2> {
            let place =
                |index: u8| Vec2::new(f32::from(index / 4) * 0.5 - 20.0 + walked_m, f32::from(index % 4) * 0.5 - 0.75);
            (0..240).map(place).collect()
        };
        for step in 100..200 {
            section.push(&lattice_m(0.1 * step as f32), &lattice_m(0.1 * (step + 1) as f32), 0.1);
        }
        let seen = section.seen().unwrap();
        assert!((seen.per_m2 - 4.0).abs() < 0.05 && (seen.speed_mps - 1.0).abs() < 1e-3, "{seen:?}");
        assert_eq!(MeasuredSection::new(Vec2::ZERO, Vec2::ONE).seen(), None);
    }

    #[test]
    fn weidmanns_diagram_has_his_ends_and_falls_between() {
        assert!((weidmann_mps(0.0) - 1.34).abs() < 1e-9 && weidmann_mps(5.4).abs() < 1e-9 && weidmann_mps(7.0) == 0.0);
        assert!((weidmann_mps(1.0) - 1.06).abs() < 0.005 && (weidmann_mps(2.0) - 0.61).abs() < 0.005);
    }
}

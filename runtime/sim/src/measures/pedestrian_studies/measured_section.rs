//! Density and speed in a rectangle of the floor, and Weidmann's fundamental diagram to compare them with.
//!
//! The classical measurement: density is the number of agents in the section divided by its area, speed their mean
//! along the corridor; both averaged over frames, each frame weighted by its number of agents. World, metres, seconds.

use glam::Vec2;

/// Free speed, m/s: Weidmann 1993, "Transporttechnik der Fussgänger".
const FREE_MPS: f64 = 1.34;
/// Constant of Weidmann's fit, 1/m².
const FIT_PER_M2: f64 = 1.913;
/// Density of standstill, 1/m²: Weidmann 1993.
const STANDSTILL_PER_M2: f64 = 5.4;

/// Speed of a one-way flow on level ground at a density (Weidmann 1993), m/s.
pub fn weidmann_mps(per_m2: f64) -> f64 {
    if per_m2 <= 0.0 {
        return FREE_MPS;
    }
    let below_standstill = (1.0 / per_m2 - 1.0 / STANDSTILL_PER_M2).max(0.0);
    FREE_MPS * (1.0 - libm::exp(-FIT_PER_M2 * below_standstill))
}

/// A rectangle of the floor, and counts of the agents in it.
#[derive(Clone, Debug)]
pub struct MeasuredSection {
    low_m: Vec2,
    high_m: Vec2,
    agents: usize,
    agents_squared: usize,
    speeds_mps: f64,
}

/// Density and speed in a section, averaged over frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionMeans {
    /// Density, agents/m².
    pub per_m2: f64,
    /// Mean speed in +x, m/s.
    pub speed_mps: f64,
}

impl MeasuredSection {
    /// No frames yet; the corners of a rectangle along the axes, in which agents walk in +x.
    pub fn new(low_m: Vec2, high_m: Vec2) -> Self {
        Self { low_m, high_m, agents: 0, agents_squared: 0, speeds_mps: 0.0 }
    }

    /// Adds one step, given every root before and after it.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2], dt_s: f64) {
        let is_inside = |at_m: Vec2| at_m.cmpge(self.low_m).all() && at_m.cmplt(self.high_m).all();
        let mut agents = 0;
        for (from_m, to_m) in before_m.iter().zip(after_m).filter(|(_, to_m)| is_inside(**to_m)) {
            agents += 1;
            self.speeds_mps += f64::from(to_m.x - from_m.x) / dt_s;
        }
        self.agents += agents;
        self.agents_squared += agents * agents;
    }

    /// The means over all frames so far; none where no agent was in the section.
    pub fn means(&self) -> Option<SectionMeans> {
        let area_m2 = f64::from((self.high_m - self.low_m).element_product());
        (self.agents > 0).then(|| SectionMeans {
            per_m2: self.agents_squared as f64 / self.agents as f64 / area_m2,
            speed_mps: self.speeds_mps / self.agents as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walking_lattice_has_its_density_and_speed() {
        let mut section = MeasuredSection::new(Vec2::new(0.0, -1.0), Vec2::new(4.0, 1.0));
        let lattice_m = |walked_m: f32| -> Vec<Vec2> {
            let position_m =
                |index: u8| Vec2::new(f32::from(index / 4) * 0.5 - 20.0 + walked_m, f32::from(index % 4) * 0.5 - 0.75);
            (0..240).map(position_m).collect()
        };
        for step in 100..200 {
            section.push(&lattice_m(0.1 * step as f32), &lattice_m(0.1 * (step + 1) as f32), 0.1);
        }
        let means = section.means().unwrap();
        assert!((means.per_m2 - 4.0).abs() < 0.05 && (means.speed_mps - 1.0).abs() < 1e-3, "{means:?}");
        assert_eq!(MeasuredSection::new(Vec2::ZERO, Vec2::ONE).means(), None);
    }

    #[test]
    fn weidmanns_diagram_has_his_ends_and_falls_between() {
        assert!((weidmann_mps(0.0) - 1.34).abs() < 1e-9 && weidmann_mps(5.4).abs() < 1e-9 && weidmann_mps(7.0) == 0.0);
        assert!((weidmann_mps(1.0) - 1.06).abs() < 0.005 && (weidmann_mps(2.0) - 0.61).abs() < 0.005);
    }
}

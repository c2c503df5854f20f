//! Random numbers for positions that a source draws: SplitMix64 (Steele, Lea, Flood 2014), seeded, the same everywhere.

use crate::scene::DrawnNumber;

/// Normal numbers that are drawn until one lies within its bounds.
const DRAWS_MAX: usize = 100;

/// A generator.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of a distribution.
    pub(crate) fn draw(&mut self, drawn: DrawnNumber) -> f64 {
        match drawn {
            DrawnNumber::Constant(value) => value,
            DrawnNumber::Uniform { from, to } => from + (to - from) * self.unit(),
            DrawnNumber::Normal { mean, deviation, .. } => {
                let [least, greatest] = drawn.bounds();
                for _ in 0..DRAWS_MAX {
                    // Box and Muller.
                    let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
                    let value = mean + deviation * radius * libm::cos(std::f64::consts::TAU * self.unit());
                    if (least..=greatest).contains(&value) {
                        return value;
                    }
                }
                mean.clamp(least.min(greatest), greatest)
            }
        }
    }
}

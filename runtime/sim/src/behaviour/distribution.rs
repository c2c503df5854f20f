//! A number that is fixed, or drawn for each agent.

use serde::{Deserialize, Serialize};

use crate::maths::random::SplitMix64;

/// Draws outside `min` and `max` before a normal distribution is clamped.
const DRAWS_MAX: usize = 64;

/// A number that is fixed, or drawn for each agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    /// Always the same.
    Constant(f32),
    /// Uniform between two numbers.
    Uniform {
        /// Least number.
        from: f32,
        /// Greatest number.
        to: f32,
    },
    /// Normal; numbers outside `min` and `max` are drawn again.
    Normal {
        /// Mean before the limits.
        mean: f32,
        /// Standard deviation before the limits.
        deviation: f32,
        /// Least number.
        min: f32,
        /// Greatest number.
        max: f32,
    },
}

impl Distribution {
    /// Draws a number.
    pub fn draw(&self, random: &mut SplitMix64) -> f32 {
        match *self {
            Self::Constant(value) => value,
            Self::Uniform { from, to } => from + (to - from) * random.unit() as f32,
            Self::Normal { mean, deviation, min, max } => {
                let mut drawn = mean + deviation * standard_normal(random);
                for _ in 1..DRAWS_MAX {
                    if (min..=max).contains(&drawn) {
                        break;
                    }
                    drawn = mean + deviation * standard_normal(random);
                }
                drawn.clamp(min, max)
            }
        }
    }

    /// Least and greatest number that may be drawn.
    pub fn bounds(&self) -> [f32; 2] {
        match *self {
            Self::Constant(value) => [value; 2],
            Self::Uniform { from, to } => [from, to],
            Self::Normal { min, max, .. } => [min, max],
        }
    }
}

/// A number of mean 0 and deviation 1 (Box and Muller 1958).
fn standard_normal(random: &mut SplitMix64) -> f32 {
    // 1 − u lies in (0, 1], so the logarithm is finite.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - random.unit()));
    (radius * libm::cos(std::f64::consts::TAU * random.unit())) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, standard deviation, least and greatest of many draws.
    fn moments(distribution: Distribution) -> [f32; 4] {
        let mut random = SplitMix64::new(5, 1);
        let drawn: Vec<f32> = (0..50_000).map(|_| distribution.draw(&mut random)).collect();
        let mean = drawn.iter().sum::<f32>() / drawn.len() as f32;
        let variance = drawn.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>() / drawn.len() as f32;
        let [least, greatest] = [f32::min, f32::max].map(|pick| drawn.iter().copied().reduce(pick).unwrap());
        [mean, variance.sqrt(), least, greatest]
    }

    fn check(distribution: Distribution, mean: f32, deviation: f32) {
        let [drawn_mean, drawn_deviation, least, greatest] = moments(distribution);
        assert!((drawn_mean - mean).abs() < 0.01 && (drawn_deviation - deviation).abs() < 0.01, "{drawn_mean}");
        let [min, max] = distribution.bounds();
        assert!(least >= min && greatest <= max, "{least} to {greatest}");
    }

    #[test]
    fn draws_have_the_stated_moments_and_bounds() {
        check(Distribution::Constant(1.5), 1.5, 0.0);
        check(Distribution::Uniform { from: 2.0, to: 3.0 }, 2.5, 0.2887);
        check(Distribution::Normal { mean: 1.34, deviation: 0.26, min: 0.0, max: 3.0 }, 1.34, 0.26);
        // Half of a normal distribution: mean √(2/π), deviation √(1 − 2/π).
        check(Distribution::Normal { mean: 0.0, deviation: 1.0, min: 0.0, max: 9.0 }, 0.798, 0.603);
    }

    #[test]
    fn limits_far_from_the_mean_end_the_draws() {
        let far = Distribution::Normal { mean: 0.0, deviation: 1.0, min: 50.0, max: 51.0 };
        assert!((50.0..=51.0).contains(&far.draw(&mut SplitMix64::new(1, 0))));
    }
}

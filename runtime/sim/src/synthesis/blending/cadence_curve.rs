//! Cadence of the straight walks of a database over speed, and the rate at which a body of another cadence plays them.
//!
//! A body that plays the gait of speed v/r at r times its rate walks at v with the cadence r·f(v/r), where f(v) is that
//! of the examples. Its planted feet hold, since root and phase change alike. For c times the cadence of others at
//! equal speed,
//!
//! ```text
//! r·f(v/r) = c·f(v).
//! ```
//!
//! In people f grows with the square root of speed: step length and cadence keep their ratio, the walk ratio (Sekiya
//! and Nagasaki 1998, *Gait & Posture* 7, 225–227). Then r = c². Clips follow it roughly; f is taken from them, and
//! grows with no higher power than ⅔, so that r lies between 1 and c³.
//!
//! Speeds in m/s, f in strides per second.

use motiondb::motion::Parameters;

/// Least and greatest speed of the curve, m/s: a stroll, and a run.
const SPEEDS_MPS: [f32; 2] = [0.4, 4.0];
/// Number of speeds of the curve.
const COUNT: usize = 33;
/// Greatest power of speed by which cadence grows.
const POWER_MAX: f32 = 2.0 / 3.0;
/// Halvings of the interval in which ln r lies: to less than 0.1 % of r.
const HALVINGS: usize = 9;

/// ln f over ln v, in equal steps.
#[derive(Clone, Debug)]
pub(crate) struct CadenceCurve {
    first: f32,
    step: f32,
    /// ln f; the origin is free.
    logarithms: [f32; COUNT],
}

impl CadenceCurve {
    /// The curve of a database that walks at parameters with `strides_hz` strides per second.
    pub(crate) fn new(strides_hz: impl Fn(Parameters) -> f32) -> Self {
        let [first, last] = SPEEDS_MPS.map(libm::logf);
        let step = (last - first) / (COUNT - 1) as f32;
        let logarithm = |index: usize| {
            let speed_mps = libm::expf(first + step * index as f32);
            libm::logf(strides_hz(Parameters { speed_mps, ..Parameters::default() }))
        };
        let found: [f32; COUNT] = std::array::from_fn(logarithm);
        let mut logarithms = [0.0; COUNT];
        for index in 1..COUNT {
            let growth = (found[index] - found[index - 1]).clamp(0.0, POWER_MAX * step);
            logarithms[index] = logarithms[index - 1] + growth;
        }
        Self { first, step, logarithms }
    }

    /// r of a body at a speed, with `cadence` times the cadence of others.
    pub(crate) fn playback_rate(&self, speed_mps: f32, cadence: f32) -> f32 {
        if cadence == 1.0 {
            return 1.0;
        }
        let speed = libm::logf(speed_mps.clamp(SPEEDS_MPS[0], SPEEDS_MPS[1]));
        let gain = libm::logf(cadence);
        let wanted = gain + self.logarithm(speed);
        let mut ends = [gain.min(3.0 * gain), gain.max(3.0 * gain)];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (ends[0] + ends[1]);
            ends[usize::from(middle + self.logarithm(speed - middle) > wanted)] = middle;
        }
        libm::expf(0.5 * (ends[0] + ends[1]))
    }

    /// ln f at ln v; constant beyond the ends.
    fn logarithm(&self, speed: f32) -> f32 {
        let position = ((speed - self.first) / self.step).clamp(0.0, (COUNT - 1) as f32);
        let index = (position as usize).min(COUNT - 2);
        let [low, high] = [self.logarithms[index], self.logarithms[index + 1]];
        low + (position - index as f32) * (high - low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_power(power: f32) -> CadenceCurve {
        CadenceCurve::new(|parameters| 0.9 * libm::powf(parameters.speed_mps, power))
    }

    #[test]
    fn the_cadence_is_as_wanted_at_every_speed() {
        for power in [0.2, 0.5, 0.6] {
            let curve = of_power(power);
            for (speed_mps, cadence) in [(0.7, 0.9), (1.3, 1.05), (1.3, 0.95), (2.0, 1.12)] {
                let rate = curve.playback_rate(speed_mps, cadence);
                let reached = rate * libm::powf(1.0 / rate, power);
                assert!((reached - cadence).abs() < 2e-3, "{power}: {reached} instead of {cadence}");
            }
        }
    }

    #[test]
    fn a_curve_that_is_too_steep_keeps_the_rate_within_bounds() {
        let rates = [0.88, 1.12].map(|cadence| of_power(1.4).playback_rate(1.3, cadence));
        assert!((rates[0] - 0.68).abs() < 5e-3 && (rates[1] - 1.405).abs() < 5e-3, "{rates:?}");
    }

    #[test]
    fn others_play_the_clips_as_they_are() {
        assert_eq!(of_power(0.5).playback_rate(1.3, 1.0), 1.0);
    }
}

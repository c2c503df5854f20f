//! How much successive strides deviate from their mean. Grows by one stride at a time, so that long clips are quick.

use crate::gait::stride::Stride;

/// Greatest deviation in speed of a stride of a steady window from the mean, m/s.
const STEADY_SPEED_MPS: f64 = 0.12;
/// The same as a share of the mean speed; the greater of both limits counts.
const STEADY_SPEED_SHARE: f64 = 0.12;
/// Greatest deviation in turn rate, rad/s: 15 °/s.
const STEADY_TURN_RAD_S: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// Greatest deviation of the period, share of the mean period.
const STEADY_PERIOD_SHARE: f64 = 0.15;

/// Means and extremes of some successive strides.
#[derive(Default)]
pub(crate) struct StrideSpread {
    strides: usize,
    speed_mps: ValueSpread,
    strafe_mps: ValueSpread,
    turn_rate_rad_s: ValueSpread,
    period_frames: ValueSpread,
}

impl StrideSpread {
    /// Adds one stride.
    pub(crate) fn add(&mut self, stride: &Stride) {
        self.strides += 1;
        self.speed_mps.add(stride.arc.rates.speed_mps);
        self.strafe_mps.add(stride.arc.rates.strafe_mps);
        self.turn_rate_rad_s.add(stride.arc.rates.turn_rate_rad_s);
        self.period_frames.add(stride.period_frames);
    }

    /// Greatest deviation of any stride from the mean, divided by its limit: at most 1 in a steady window.
    pub(crate) fn deviation(&self) -> f64 {
        let mean = |spread: &ValueSpread| spread.sum / self.strides as f64;
        let deviation = |spread: &ValueSpread, limit: f64| {
            let mean = mean(spread);
            (spread.greatest - mean).max(mean - spread.least) / limit
        };
        let speed_limit_mps = speed_limit_mps(mean(&self.speed_mps), mean(&self.strafe_mps));
        deviation(&self.speed_mps, speed_limit_mps)
            .max(deviation(&self.strafe_mps, speed_limit_mps))
            .max(deviation(&self.turn_rate_rad_s, STEADY_TURN_RAD_S))
            .max(deviation(&self.period_frames, STEADY_PERIOD_SHARE * mean(&self.period_frames)))
    }

    /// Whether no further stride can make the sequence steady again.
    ///
    /// Its extremes lie three limits apart where two are too many, and extremes that move widen the limits by less than
    /// they move.
    pub(crate) fn is_hopeless(&self) -> bool {
        let speed_limit_mps = speed_limit_mps(self.speed_mps.farthest(), self.strafe_mps.farthest());
        self.speed_mps.width() > 3.0 * speed_limit_mps
            || self.strafe_mps.width() > 3.0 * speed_limit_mps
            || self.turn_rate_rad_s.width() > 3.0 * STEADY_TURN_RAD_S
            || self.period_frames.width() > 3.0 * STEADY_PERIOD_SHARE * self.period_frames.farthest()
    }
}

fn speed_limit_mps(speed_mps: f64, strafe_mps: f64) -> f64 {
    STEADY_SPEED_MPS.max(STEADY_SPEED_SHARE * libm::hypot(speed_mps, strafe_mps))
}

/// Sum and extremes of one quantity.
struct ValueSpread {
    sum: f64,
    least: f64,
    greatest: f64,
}

impl Default for ValueSpread {
    fn default() -> Self {
        Self { sum: 0.0, least: f64::INFINITY, greatest: f64::NEG_INFINITY }
    }
}

impl ValueSpread {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
    }

    fn width(&self) -> f64 {
        self.greatest - self.least
    }

    /// The extreme that is farther from 0, as a magnitude.
    fn farthest(&self) -> f64 {
        self.greatest.abs().max(self.least.abs())
    }
}

//! Which strides of a clip make its example: all of a loop, else the longest run that is steady (`definitions.md`,
//! "Example").

use crate::stride::{Landmark, Stride};

/// Strides of a steady window differ from their mean by at most: speed (m/s, or this share of it), turn rate, share of
/// the period.
const STEADY_SPEED_MPS: f64 = 0.12;
const STEADY_SPEED_SHARE: f64 = 0.12;
const STEADY_TURN_RAD_S: f64 = 15.0 * std::f64::consts::PI / 180.0;
const STEADY_PERIOD_SHARE: f64 = 0.15;
/// Speeds of the two steps of a lone stride differ by at most this, or this share of their mean.
const STEP_SPEED_MPS: f64 = 0.2;
const STEP_SPEED_SHARE: f64 = 0.25;

/// Of a loop all strides of one round, from the first landmark of its middle copy.
pub fn round_of_strides(strides: &[Option<Stride>], landmarks: &[Landmark], round: f64) -> Option<Vec<Stride>> {
    // Rounding must not tell a landmark from its copy one round later.
    let first = landmarks.iter().position(|mark| mark.frame >= round - 0.25)?;
    let past = landmarks.iter().position(|mark| mark.frame >= 2.0 * round - 0.25)?;
    let whole = (past - first).is_multiple_of(2) && past > first;
    if !whole {
        return None;
    }
    (first..past).step_by(2).map(|index| strides.get(index).copied().flatten()).collect()
}

/// The longest run of strides, end to end, that are like their mean; of several as long, the steadiest.
pub fn steady_window(strides: &[Option<Stride>]) -> Option<Vec<Stride>> {
    let mut best: Option<(usize, f64, usize)> = None;
    for first in 0..strides.len() {
        let mut window = Window::default();
        // Every stride counts for steadiness, also those that begin with the other foot; every second one goes into the
        // mean.
        for (length, stride) in strides[first..].iter().map_while(Option::as_ref).enumerate() {
            window.add(stride);
            let Some(deviation) = window.deviation().filter(|_| length.is_multiple_of(2)) else { continue };
            let alone = length == 0;
            let longer = best.is_none_or(|best| (length, -deviation) > (best.0, -best.1));
            if longer && !(alone && speeds_up(stride.step_speeds_mps)) {
                best = Some((length, deviation, first));
            }
        }
    }
    let (length, _, first) = best?;
    Some(strides[first..=first + length].iter().step_by(2).flatten().copied().collect())
}

/// Some strides, one after the other: what they have in common. Grows by a stride at a time, so that long takes are
/// quick.
#[derive(Default)]
struct Window {
    strides: usize,
    speed_mps: Spread,
    strafe_mps: Spread,
    turn_rate_rad_s: Spread,
    period_frames: Spread,
}

impl Window {
    fn add(&mut self, stride: &Stride) {
        self.strides += 1;
        self.speed_mps.add(stride.arc.rates.speed_mps);
        self.strafe_mps.add(stride.arc.rates.strafe_mps);
        self.turn_rate_rad_s.add(stride.arc.rates.turn_rate_rad_s);
        self.period_frames.add(stride.period_frames);
    }

    /// The greatest deviation of any stride from the mean, 1 at the limit; none beyond.
    fn deviation(&self) -> Option<f64> {
        let mean = |spread: &Spread| spread.sum / self.strides as f64;
        let deviation = |spread: &Spread, limit: f64| {
            let mean = mean(spread);
            (spread.greatest - mean).max(mean - spread.least) / limit
        };
        let speed_mps = libm::hypot(mean(&self.speed_mps), mean(&self.strafe_mps));
        let speed_limit_mps = STEADY_SPEED_MPS.max(STEADY_SPEED_SHARE * speed_mps);
        let greatest = deviation(&self.speed_mps, speed_limit_mps)
            .max(deviation(&self.strafe_mps, speed_limit_mps))
            .max(deviation(&self.turn_rate_rad_s, STEADY_TURN_RAD_S))
            .max(deviation(&self.period_frames, STEADY_PERIOD_SHARE * mean(&self.period_frames)));
        (greatest <= 1.0).then_some(greatest)
    }
}

/// Sum and ends of one value.
struct Spread {
    sum: f64,
    least: f64,
    greatest: f64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { sum: 0.0, least: f64::INFINITY, greatest: f64::NEG_INFINITY }
    }
}

impl Spread {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
    }
}

/// Whether a body goes much faster in one step than in the other: with no other stride to compare with, it starts or
/// stops.
fn speeds_up([first, second]: [f64; 2]) -> bool {
    (second - first).abs() > STEP_SPEED_MPS.max(STEP_SPEED_SHARE * 0.5 * (first + second))
}

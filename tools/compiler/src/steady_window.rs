//! Which strides of a clip make its example: all of a loop, else the longest run that is steady (`definitions.md`, "Example").

use crate::stride::{Landmark, Stride};

/// Strides of a steady window differ from their mean by at most: speed (m/s, or this share of it), turn rate, share of the period.
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
    let mut best: Option<(usize, f64, Vec<Stride>)> = None;
    for first in 0..strides.len() {
        for last in (first..strides.len()).step_by(2) {
            // Every stride counts for steadiness, also those that begin with the other foot; every second one goes into the mean.
            let Some(all) = strides[first..=last].iter().copied().collect::<Option<Vec<Stride>>>() else { break };
            let Some(deviation) = deviation(&all) else { continue };
            if all.len() == 1 && speeds_up(all[0].step_speeds_mps) {
                continue;
            }
            let longer = best.as_ref().is_none_or(|best| (last - first, -deviation) > (best.0, -best.1));
            if longer {
                best = Some((last - first, deviation, all.into_iter().step_by(2).collect()));
            }
        }
    }
    best.map(|(_, _, strides)| strides)
}

/// The greatest deviation of any stride from the mean, 1 at the limit; none beyond.
fn deviation(strides: &[Stride]) -> Option<f64> {
    let mean = |value: fn(&Stride) -> f64| strides.iter().map(value).sum::<f64>() / strides.len() as f64;
    let spread = |value: fn(&Stride) -> f64, limit: f64| {
        let mean = mean(value);
        strides.iter().map(|stride| (value(stride) - mean).abs() / limit).fold(0.0, f64::max)
    };
    let (forward, left) = (mean(|s| s.arc.rates.speed_mps), mean(|s| s.arc.rates.strafe_mps));
    let speed_limit = STEADY_SPEED_MPS.max(STEADY_SPEED_SHARE * libm::hypot(forward, left));
    let deviation = spread(|s| s.arc.rates.speed_mps, speed_limit)
        .max(spread(|s| s.arc.rates.strafe_mps, speed_limit))
        .max(spread(|s| s.arc.rates.turn_rate_rad_s, STEADY_TURN_RAD_S))
        .max(spread(|s| s.period_frames, STEADY_PERIOD_SHARE * mean(|s| s.period_frames)));
    (deviation <= 1.0).then_some(deviation)
}

/// Whether a body goes much faster in one step than in the other: with no other stride to compare with, it starts or stops.
fn speeds_up([first, second]: [f64; 2]) -> bool {
    (second - first).abs() > STEP_SPEED_MPS.max(STEP_SPEED_SHARE * 0.5 * (first + second))
}

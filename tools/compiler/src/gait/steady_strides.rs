//! Which strides of a clip make examples: all strides of a loop, else every sequence that is steady, the longest first.
//!
//! A long capture walks, turns, hesitates and speeds up. Each part of it in which the strides are alike is a steady
//! window. Windows are taken greedily: the longest of the clip, then the longest of the parts before and after it, so
//! that they are disjoint. Times in frames of the clip.

use motiondb::diagnostic::unfit::{STEP_TURN_RAD_S, half_speed_limit_mps};

use crate::gait::stride::{Landmark, Stride};
use crate::gait::stride_spread::StrideSpread;

/// Tolerance for equal landmarks, frames: they lie on frames and half-way between.
const SAME_FRAME: f64 = 0.25;

/// The steps of a clip as one reading of its contacts shows them (readings: [`crate::gait::windows`]).
#[derive(Clone, Debug)]
pub(crate) struct ClipSteps {
    /// Mid-stances of both feet, in order of time.
    pub(crate) landmarks: Vec<Landmark>,
    /// The stride over each three successive landmarks, where it is one.
    pub(crate) strides: Vec<Option<Stride>>,
}

/// A steady part of a clip.
#[derive(Clone, Debug)]
pub(crate) struct SteadyStrides {
    /// Index of the reading of the contacts that shows the window.
    pub(crate) reading: usize,
    /// Strides of the window, end to end.
    pub(crate) strides: Vec<Stride>,
    /// Greatest deviation of any stride from their mean, divided by its limit.
    deviation: f64,
}

/// All strides of one round of a loop, from the first landmark of its middle copy, if they are alike.
pub(crate) fn round_of_strides(steps: &ClipSteps, round: f64) -> Option<Vec<Stride>> {
    let first = steps.landmarks.iter().position(|mark| mark.frame >= round - SAME_FRAME)?;
    let past = steps.landmarks.iter().position(|mark| mark.frame >= 2.0 * round - SAME_FRAME)?;
    let whole = (past - first).is_multiple_of(2) && past > first;
    if !whole {
        return None;
    }
    let strides = (first..past).step_by(2).map(|index| steps.strides.get(index).copied().flatten());
    strides.collect::<Option<Vec<Stride>>>().filter(|strides| are_alike(strides))
}

/// Whether strides deviate from their mean within the limits: the mean of a round that speeds up would be no model.
fn are_alike(strides: &[Stride]) -> bool {
    let mut spread = StrideSpread::default();
    strides.iter().for_each(|stride| spread.add(stride));
    spread.deviation() <= 1.0
}

/// All steady windows between two frames, the longest first; of several as long the steadiest, then the first.
///
/// If several readings of the contacts show the window, the first that shows it longest counts.
pub(crate) fn steady_windows(readings: &[ClipSteps], [first, last]: [f64; 2]) -> Vec<SteadyStrides> {
    let mut windows: Vec<SteadyStrides> = Vec::new();
    let mut spans = vec![[first, last]];
    while let Some(span) = spans.pop() {
        let found = readings.iter().enumerate().filter_map(|(reading, steps)| longest_window(steps, reading, span));
        // The first of the longest: `max_by_key` alone would take the last.
        let Some(window) = found.rev().max_by_key(|window| window.strides.len()) else { continue };
        let [start, end] = window.frames();
        spans.extend([[span[0], start], [end, span[1]]]);
        windows.push(window);
    }
    windows.sort_by(|a, b| {
        let by_length = b.strides.len().cmp(&a.strides.len());
        by_length.then(a.deviation.total_cmp(&b.deviation)).then(a.frames()[0].total_cmp(&b.frames()[0]))
    });
    windows
}

impl SteadyStrides {
    /// Frames of the first and of the last landmark.
    pub(crate) fn frames(&self) -> [f64; 2] {
        [self.strides[0].first_frame(), self.strides[self.strides.len() - 1].last_frame()]
    }
}

/// The longest sequence of strides within a span that are like their mean; of several as long, the steadiest.
fn longest_window(steps: &ClipSteps, reading: usize, [start, end]: [f64; 2]) -> Option<SteadyStrides> {
    let from = steps.landmarks.partition_point(|mark| mark.frame < start - SAME_FRAME);
    let past = steps.landmarks.partition_point(|mark| mark.frame <= end + SAME_FRAME).saturating_sub(2);
    let strides = steps.strides.get(from..past).unwrap_or_default();
    let mut best: Option<(usize, f64, usize)> = None;
    for first in 0..strides.len() {
        // The rest is shorter than the longest. A day on a treadmill is one window, found at the first stride.
        if best.is_some_and(|(length, ..)| strides.len() - first <= length) {
            break;
        }
        let mut spread = StrideSpread::default();
        // Every stride counts for steadiness, also one that begins with the other foot. Every second one goes into the
        // mean.
        for (length, stride) in strides[first..].iter().map_while(Option::as_ref).enumerate() {
            spread.add(stride);
            if spread.is_hopeless() {
                break;
            }
            let deviation = if length == 0 { unevenness(stride) } else { spread.deviation() };
            let longer = best.is_none_or(|best| (length, -deviation) > (best.0, -best.1));
            if length.is_multiple_of(2) && deviation <= 1.0 && longer {
                best = Some((length, deviation, first));
            }
        }
    }
    let (length, deviation, first) = best?;
    let strides = strides[first..=first + length].iter().step_by(2).flatten().copied().collect();
    Some(SteadyStrides { reading, strides, deviation })
}

/// Difference between halves of a lone stride, divided by its limit: a body much faster in one of them starts, stops or
/// turns back.
pub(crate) fn unevenness(stride: &Stride) -> f64 {
    let [least_mps, greatest_mps] = stride.half_speeds_mps;
    let [first_rad_s, second_rad_s] = stride.step_turn_rates_rad_s;
    ((greatest_mps - least_mps) / half_speed_limit_mps(stride.half_speeds_mps))
        .max((second_rad_s - first_rad_s).abs() / STEP_TURN_RAD_S)
}

#[cfg(test)]
mod tests {
    use super::*;
    use motiondb::body::Side;

    const STEP_FRAMES: f64 = 15.0;

    /// The steps of a walk; a stride begins with each, at these speeds (m/s).
    fn steps(speeds_mps: &[f64]) -> ClipSteps {
        let frame = |index: usize| STEP_FRAMES * index as f64;
        let stride = |(index, &speed_mps): (usize, &f64)| {
            let mut stride = Stride { zero_frame: frame(index), period_frames: 2.0 * STEP_FRAMES, ..Stride::default() };
            stride.arc.rates.speed_mps = speed_mps;
            Some(stride)
        };
        ClipSteps {
            landmarks: (0..speeds_mps.len() + 2)
                .map(|index| Landmark { side: Side::BOTH[index % 2], frame: frame(index) })
                .collect(),
            strides: speeds_mps.iter().enumerate().map(stride).collect(),
        }
    }

    #[track_caller]
    fn check_windows(speeds_mps: &[f64], windows: &[[usize; 2]]) {
        let end = STEP_FRAMES * (speeds_mps.len() + 1) as f64;
        let found = steady_windows(&[steps(speeds_mps)], [0.0, end]);
        let frames = |window: &[usize; 2]| window.map(|index| STEP_FRAMES * index as f64);
        let found: Vec<[f64; 2]> = found.iter().map(SteadyStrides::frames).collect();
        assert_eq!(found, windows.iter().map(frames).collect::<Vec<_>>());
    }

    #[test]
    fn of_equal_lengths_the_steadiest_comes_first() {
        check_windows(&[1.0, 1.05, 1.0, 3.0, 3.0, 3.0], &[[3, 7], [0, 2]]);
        check_windows(&[1.0, 1.0, 1.0, 3.0, 3.05, 3.0], &[[0, 4], [4, 6]]);
    }

    #[test]
    fn a_lone_stride_that_stops_within_is_not_steady() {
        let check = |half_speeds_mps: [f64; 2], is_steady: bool| {
            let mut found = steps(&[1.0]);
            found.strides[0].as_mut().unwrap().half_speeds_mps = half_speeds_mps;
            assert_eq!(steady_windows(&[found], [0.0, 2.0 * STEP_FRAMES]).len(), usize::from(is_steady));
        };
        check([0.95, 1.1], true);
        check([0.1, 0.6], false);
    }

    #[test]
    fn a_day_on_a_treadmill_is_one_window() {
        check_windows(&[1.2; 170_001], &[[0, 170_002]]);
    }
}

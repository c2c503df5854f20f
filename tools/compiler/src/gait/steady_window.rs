//! Which strides of a clip make examples: all of a loop, else every run that is steady, the longest first.
//!
//! A long capture walks, turns, hesitates, goes on faster: each part of it in which the strides are alike is a window
//! of its own. Windows are taken greedily, the longest of the clip, then the longest of what it leaves before and after
//! itself, so that they are disjoint. Times are in frames of the clip.

use crate::gait::stride::{Landmark, Stride};

/// Strides of a steady window differ from their mean by at most: speed (m/s, or this share of it), turn rate, share of
/// the period.
const STEADY_SPEED_MPS: f64 = 0.12;
const STEADY_SPEED_SHARE: f64 = 0.12;
const STEADY_TURN_RAD_S: f64 = 15.0 * std::f64::consts::PI / 180.0;
const STEADY_PERIOD_SHARE: f64 = 0.15;
/// Speeds of the two steps of a lone stride differ by at most this, or this share of their mean.
const STEP_SPEED_MPS: f64 = 0.2;
const STEP_SPEED_SHARE: f64 = 0.25;
/// And so do their turn rates: a straight run sways by as much as this from step to step, a walk by half of it.
const STEP_TURN_RAD_S: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// Landmarks lie on frames and half-way between; rounding must not tell one from itself, or from its copy one round
/// later.
const SAME_FRAME: f64 = 0.25;

/// The steps of a clip as one reading of its contacts shows them.
#[derive(Clone, Debug)]
pub struct Steps {
    /// Middles of all contacts, in order of time.
    pub landmarks: Vec<Landmark>,
    /// The stride over each three successive landmarks, where it is one.
    pub strides: Vec<Option<Stride>>,
}

/// A steady part of a clip.
#[derive(Clone, Debug)]
pub struct SteadyWindow {
    /// Which reading of the contacts shows it.
    pub reading: usize,
    /// Its strides, end to end.
    pub strides: Vec<Stride>,
    /// The greatest deviation of any of them from their mean, 1 at the limit.
    deviation: f64,
}

/// Of a loop all strides of one round, from the first landmark of its middle copy, if they are alike.
pub(crate) fn round_of_strides(steps: &Steps, round: f64) -> Option<Vec<Stride>> {
    let first = steps.landmarks.iter().position(|mark| mark.frame >= round - SAME_FRAME)?;
    let past = steps.landmarks.iter().position(|mark| mark.frame >= 2.0 * round - SAME_FRAME)?;
    let whole = (past - first).is_multiple_of(2) && past > first;
    if !whole {
        return None;
    }
    let strides = (first..past).step_by(2).map(|index| steps.strides.get(index).copied().flatten());
    strides.collect::<Option<Vec<Stride>>>().filter(|strides| are_alike(strides))
}

/// A round that goes faster in one part than in another is none to take the mean of.
fn are_alike(strides: &[Stride]) -> bool {
    let mut run = Run::default();
    strides.iter().for_each(|stride| run.add(stride));
    run.deviation() <= 1.0
}

/// All steady windows between two frames, the longest first; of several as long the steadiest, then the first. Of
/// several readings of the contacts the first that shows a window longest counts.
pub(crate) fn steady_windows(readings: &[Steps], [first, last]: [f64; 2]) -> Vec<SteadyWindow> {
    let mut windows: Vec<SteadyWindow> = Vec::new();
    let mut spans = vec![[first, last]];
    while let Some(span) = spans.pop() {
        let found = readings.iter().enumerate().filter_map(|(reading, steps)| longest(steps, reading, span));
        // The first of the longest: `max_by_key` alone would take the last.
        let Some(window) = found.rev().max_by_key(|window| window.strides.len()) else { continue };
        let [start, end] = window.frames();
        spans.extend([[span[0], start], [end, span[1]]]);
        windows.push(window);
    }
    windows.sort_by(|a, b| {
        b.strides
            .len()
            .cmp(&a.strides.len())
            .then(a.deviation.total_cmp(&b.deviation))
            .then(a.starts().total_cmp(&b.starts()))
    });
    windows
}

impl SteadyWindow {
    fn starts(&self) -> f64 {
        self.frames()[0]
    }

    /// Its first and its last landmark.
    pub fn frames(&self) -> [f64; 2] {
        [self.strides[0].first_frame(), self.strides[self.strides.len() - 1].last_frame()]
    }
}

/// The longest run of strides within a span that are like their mean; of several as long, the steadiest.
fn longest(steps: &Steps, reading: usize, [start, end]: [f64; 2]) -> Option<SteadyWindow> {
    let from = steps.landmarks.partition_point(|mark| mark.frame < start - SAME_FRAME);
    let past = steps.landmarks.partition_point(|mark| mark.frame <= end + SAME_FRAME).saturating_sub(2);
    let strides = steps.strides.get(from..past).unwrap_or_default();
    let mut best: Option<(usize, f64, usize)> = None;
    for first in 0..strides.len() {
        // What is left is shorter than the longest: a day on a treadmill is one run, and takes one look.
        if best.is_some_and(|(length, ..)| strides.len() - first <= length) {
            break;
        }
        let mut run = Run::default();
        // Every stride counts for steadiness, also those that begin with the other foot; every second one goes into the
        // mean.
        for (length, stride) in strides[first..].iter().map_while(Option::as_ref).enumerate() {
            run.add(stride);
            if run.is_hopeless() {
                break;
            }
            let deviation = if length == 0 { unevenness(stride) } else { run.deviation() };
            let longer = best.is_none_or(|best| (length, -deviation) > (best.0, -best.1));
            if length.is_multiple_of(2) && deviation <= 1.0 && longer {
                best = Some((length, deviation, first));
            }
        }
    }
    let (length, deviation, first) = best?;
    let strides = strides[first..=first + length].iter().step_by(2).flatten().copied().collect();
    Some(SteadyWindow { reading, strides, deviation })
}

/// How unlike the two steps of a lone stride are, 1 at the limit: with no other stride to compare with, a body that
/// goes much faster in one step than in the other starts or stops.
fn unevenness(stride: &Stride) -> f64 {
    let [first_mps, second_mps] = stride.step_speeds_mps;
    let [first_rad_s, second_rad_s] = stride.step_turn_rates_rad_s;
    let limit_mps = STEP_SPEED_MPS.max(STEP_SPEED_SHARE * 0.5 * (first_mps + second_mps));
    ((second_mps - first_mps).abs() / limit_mps).max((second_rad_s - first_rad_s).abs() / STEP_TURN_RAD_S)
}

/// Some strides, one after the other: what they have in common. Grows by a stride at a time, so that long takes are
/// quick.
#[derive(Default)]
struct Run {
    strides: usize,
    speed_mps: Spread,
    strafe_mps: Spread,
    turn_rate_rad_s: Spread,
    period_frames: Spread,
}

impl Run {
    fn add(&mut self, stride: &Stride) {
        self.strides += 1;
        self.speed_mps.add(stride.arc.rates.speed_mps);
        self.strafe_mps.add(stride.arc.rates.strafe_mps);
        self.turn_rate_rad_s.add(stride.arc.rates.turn_rate_rad_s);
        self.period_frames.add(stride.period_frames);
    }

    /// The greatest deviation of any stride from the mean, 1 at the limit.
    fn deviation(&self) -> f64 {
        let mean = |spread: &Spread| spread.sum / self.strides as f64;
        let deviation = |spread: &Spread, limit: f64| {
            let mean = mean(spread);
            (spread.greatest - mean).max(mean - spread.least) / limit
        };
        let speed_limit_mps = speed_limit_mps(mean(&self.speed_mps), mean(&self.strafe_mps));
        deviation(&self.speed_mps, speed_limit_mps)
            .max(deviation(&self.strafe_mps, speed_limit_mps))
            .max(deviation(&self.turn_rate_rad_s, STEADY_TURN_RAD_S))
            .max(deviation(&self.period_frames, STEADY_PERIOD_SHARE * mean(&self.period_frames)))
    }

    /// No stride more can make it steady again: its ends lie three limits apart where two are too many, and ends that
    /// move on widen the limits by less than they move.
    fn is_hopeless(&self) -> bool {
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

    fn width(&self) -> f64 {
        self.greatest - self.least
    }

    /// The end that is farther from 0.
    fn farthest(&self) -> f64 {
        self.greatest.abs().max(self.least.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use motiondb::body::Side;

    const STEP_FRAMES: f64 = 15.0;

    /// A walk whose strides go at these speeds, m/s; one begins with each step.
    fn steps(speeds_mps: &[f64]) -> Steps {
        let frame = |index: usize| STEP_FRAMES * index as f64;
        let stride = |(index, &speed_mps): (usize, &f64)| {
            let mut stride = Stride { zero_frame: frame(index), period_frames: 2.0 * STEP_FRAMES, ..Stride::default() };
            stride.arc.rates.speed_mps = speed_mps;
            Some(stride)
        };
        Steps {
            landmarks: (0..speeds_mps.len() + 2)
                .map(|index| Landmark { side: Side::BOTH[index % 2], frame: frame(index) })
                .collect(),
            strides: speeds_mps.iter().enumerate().map(stride).collect(),
        }
    }

    fn check_windows(speeds_mps: &[f64], windows: &[[usize; 2]]) {
        let end = STEP_FRAMES * (speeds_mps.len() + 1) as f64;
        let found = steady_windows(&[steps(speeds_mps)], [0.0, end]);
        let frames = |window: &[usize; 2]| window.map(|index| STEP_FRAMES * index as f64);
        let found: Vec<[f64; 2]> = found.iter().map(SteadyWindow::frames).collect();
        assert_eq!(found, windows.iter().map(frames).collect::<Vec<_>>());
    }

    #[test]
    fn of_windows_as_long_the_steadiest_is_taken_first() {
        check_windows(&[1.0, 1.05, 1.0, 3.0, 3.0, 3.0], &[[3, 7], [0, 2]]);
        check_windows(&[1.0, 1.0, 1.0, 3.0, 3.05, 3.0], &[[0, 4], [4, 6]]);
    }

    #[test]
    fn a_day_on_a_treadmill_is_one_window_and_takes_one_look() {
        check_windows(&[1.2; 170_001], &[[0, 170_002]]);
    }
}

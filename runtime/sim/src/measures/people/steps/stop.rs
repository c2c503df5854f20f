//! Stops: how hard they brake, whether the body creeps before it rests, and how long its last step takes.
//!
//! A stop ends with the first frame of a rest, the pelvis slower than 5 cm/s for 0.3 s. It counts if the pelvis was
//! faster than 0.8 m/s within the 4 s before; its walking speed v is the median of the second before the last frame with
//! that speed, and it begins with the last frame at 0.9 v. Its peak is the greatest loss of speed in 0.2 s. The body
//! creeps while it is slower than 0.3 m/s. The closing step is the last swing that lands by 0.2 s after the start of the
//! rest. s, m/s, m/s².

use motiondb::statistics::{mean, median};
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;
use crate::measures::people::steps::start::{FULL_SHARE, PEAK_S, REST_MPS, REST_S, WALK_MPS};
use crate::measures::people::steps::swing::swings;

/// Greatest duration of a stop, s.
const STOP_MAX_S: f64 = 4.0;
/// Speed below which a body creeps, m/s.
const CREEP_MPS: f64 = 0.3;
/// Time after the start of the rest by which the last foot has landed, s.
const LANDED_S: f64 = 0.2;

/// The stops of a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stops {
    /// Number of stops.
    pub count: usize,
    /// Median duration from 90 % of the walking speed to rest, s; none without stops.
    pub duration_s: Option<f64>,
    /// Median of the peak deceleration, m/s²; none without stops.
    pub peak_mps2: Option<f64>,
    /// Median time of creeping, s; none without stops.
    pub creep_s: Option<f64>,
    /// Mean speed of creeping, m/s; none where no body creeps.
    pub creep_mps: Option<f64>,
    /// Median duration of the closing step, s; none where no foot swings.
    pub closing_step_s: Option<f64>,
}

/// What is known of one stop.
#[derive(Clone, Copy, Debug)]
struct Stop {
    duration_s: f64,
    peak_mps2: f64,
    creep_s: f64,
    creep_mps: Option<f64>,
    closing_step_s: Option<f64>,
}

/// Collects stops.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopTally {
    stops: Vec<Stop>,
}

impl StopTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let speeds_mps = track.pelvis_speeds_mps();
        let rests = track.runs(|index| speeds_mps[index] < REST_MPS);
        let rests = rests.into_iter().filter(|run| run.len() >= track.count(REST_S));
        self.stops.extend(rests.filter_map(|run| stop(track, &speeds_mps, run.start)));
    }

    /// The figures of all stops.
    pub(crate) fn finish(&self) -> Stops {
        let stops = || self.stops.iter();
        Stops {
            count: self.stops.len(),
            duration_s: median(stops().map(|stop| stop.duration_s)),
            peak_mps2: median(stops().map(|stop| stop.peak_mps2)),
            creep_s: median(stops().map(|stop| stop.creep_s)),
            creep_mps: mean(stops().filter_map(|stop| stop.creep_mps)),
            closing_step_s: median(stops().filter_map(|stop| stop.closing_step_s)),
        }
    }
}

/// The stop that ends with the frame `rest`.
fn stop(track: &BodyTrack, speeds_mps: &[f64], rest: usize) -> Option<Stop> {
    let earliest = rest.saturating_sub(track.count(STOP_MAX_S));
    let last_walking = (earliest..rest).rfind(|&index| speeds_mps[index] > WALK_MPS)?;
    let second = last_walking.saturating_sub(track.count(1.0))..last_walking;
    let walking_mps = median(speeds_mps[second].iter().copied())?;
    let full = (earliest..rest).rfind(|&index| speeds_mps[index] >= FULL_SHARE * walking_mps)?;
    let span = track.count(PEAK_S);
    let loss_mps = |index: usize| speeds_mps[index] - speeds_mps[(index + span).min(rest)];
    let creeps = (full..rest).rfind(|&index| speeds_mps[index] >= CREEP_MPS).map_or(full, |index| index + 1);
    let swings = [0, 1].into_iter().flat_map(|side| swings(track, side));
    let landed = swings.filter(|swing| swing.end > full && swing.end <= rest + track.count(LANDED_S));
    Some(Stop {
        duration_s: (rest - full) as f64 * track.dt_s,
        peak_mps2: (full..rest).map(loss_mps).fold(0.0, f64::max) / (span as f64 * track.dt_s),
        creep_s: (rest - creeps) as f64 * track.dt_s,
        creep_mps: mean(speeds_mps[creeps..rest].iter().copied()),
        closing_step_s: landed.max_by_key(|swing| swing.end).map(|swing| swing.len() as f64 * track.dt_s),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// A body that walks at 1.4 m/s, brakes at 2 m/s² from 2 s on down to a speed, creeps for a time and rests.
    fn stop_with(creep_mps: f64, creep_s: f64) -> Stops {
        let mut tally = StopTally::default();
        let braking_s = (1.4 - creep_mps) / 2.0;
        tally.add(&track(8.0, |time_s, sample| {
            let since_s = (time_s - 2.0).max(0.0);
            let braked_s = since_s.min(braking_s);
            let crept_s = (since_s - braking_s).clamp(0.0, creep_s);
            let walked_m = 1.4 * time_s.min(2.0) + 1.4 * braked_s - braked_s * braked_s;
            sample.pelvis_m.x = (walked_m + creep_mps * crept_s) as f32;
            let left_s = time_s - (2.0 + braking_s + creep_s);
            sample.planted = [true, !(-0.4 + 1e-6..-1e-6).contains(&left_s)];
        }));
        tally.finish()
    }

    #[test]
    fn a_stop_without_creep() {
        let found = stop_with(0.0, 0.0);
        assert_eq!(found.count, 1);
        assert!((found.peak_mps2.unwrap() - 2.0).abs() < 0.05, "{found:?}");
        assert!((found.duration_s.unwrap() - 0.61).abs() < 0.06, "{found:?}");
        assert!(found.creep_s.unwrap() < 0.2, "{found:?}");
        assert!((found.closing_step_s.unwrap() - 0.4).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn creep_has_its_duration_and_speed() {
        let found = stop_with(0.2, 1.2);
        assert!((found.creep_s.unwrap() - 1.25).abs() < 0.1, "{found:?}");
        assert!((found.creep_mps.unwrap() - 0.19).abs() < 0.02, "{found:?}");
    }
}

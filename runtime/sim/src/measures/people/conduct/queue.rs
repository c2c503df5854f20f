//! Queues: the share of the time in a queue in which an agent goes backward.
//!
//! An agent queues while it has a preferred velocity, has not arrived, and its mean speed over the 2 s about the frame is
//! below half its preferred speed; the first second of its track is left out. It goes backward where its velocity over
//! 0.2 s against the preferred direction exceeds 2 cm/s.

use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Half the interval over which the mean speed is taken, s.
const SPAN_S: f64 = 1.0;
/// Share of the preferred speed below which an agent queues.
const SLOW_SHARE: f32 = 0.5;
/// Least preferred speed, m/s.
const WANTED_MPS: f32 = 0.1;
/// Speed from which on an agent goes backward, m/s.
const BACKWARD_MPS: f32 = 0.02;

/// Agents in queues.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Queues {
    /// Time in queues, agent-minutes.
    pub minutes: f64,
    /// Share of that time in which an agent goes backward; none where no agent queues.
    pub backward_share: Option<f64>,
}

/// Sums time in queues.
#[derive(Clone, Debug, Default)]
pub(crate) struct QueueTally {
    queueing_s: f64,
    backward_s: f64,
}

impl QueueTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let (velocities_mps, span) = (track.velocities_mps(), track.count(SPAN_S));
        let mut path_m = vec![0.0_f32];
        for pair in track.samples.windows(2) {
            path_m.push(path_m.last().copied().unwrap_or_default() + pair[1].root_m.distance(pair[0].root_m));
        }
        let last = track.samples.len().saturating_sub(1);
        for (index, sample) in track.samples.iter().enumerate().skip(span) {
            let (from, to) = (index - span, (index + span).min(last));
            let mean_mps = (path_m[to] - path_m[from]) / ((to - from) as f64 * track.dt_s) as f32;
            let wanted_mps = sample.preferred_mps.length();
            if sample.has_arrived || wanted_mps < WANTED_MPS || mean_mps >= SLOW_SHARE * wanted_mps {
                continue;
            }
            self.queueing_s += track.dt_s;
            let ahead_mps = velocities_mps[index].dot(sample.preferred_mps) / wanted_mps;
            self.backward_s += if ahead_mps < -BACKWARD_MPS { track.dt_s } else { 0.0 };
        }
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> Queues {
        let backward_share = (self.queueing_s > 0.0).then(|| self.backward_s / self.queueing_s);
        Queues { minutes: self.queueing_s / 60.0, backward_share }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// A body that sways to and fro, ahead for 3 s and backward for 1 s in turn, at 0.3 m/s.
    fn sway(preferred_mps: f32, arrived: bool) -> Queues {
        let mut tally = QueueTally::default();
        tally.add(&track(33.0, |time_s, sample| {
            let (turns, in_turn_s) = ((time_s / 4.0).floor(), time_s.rem_euclid(4.0));
            let ahead_s = if in_turn_s < 3.0 { in_turn_s } else { 6.0 - in_turn_s };
            sample.root_m.x = (0.3 * (2.0 * turns + ahead_s)) as f32;
            sample.preferred_mps = Vec2::new(preferred_mps, 0.0);
            sample.has_arrived = arrived;
        }));
        tally.finish()
    }

    #[test]
    fn a_quarter_of_the_time_goes_backward() {
        let found = sway(1.3, false);
        assert!((found.backward_share.unwrap() - 0.25).abs() < 0.02, "{found:?}");
        assert!((found.minutes - 32.0 / 60.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn agents_that_have_arrived_or_want_no_more_do_not_queue() {
        assert_eq!(sway(1.3, true).backward_share, None);
        assert_eq!(sway(0.4, false).backward_share, None);
    }
}

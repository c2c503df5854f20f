//! First steps after a common start: which foot, and when.
//!
//! An agent counts if it stands on both feet in the first frame of the recording and lifts a foot later. Time counts
//! from the start of the recording, s.

use motiondb::statistics::percentile;
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Times that differ by no more than this are one instant, s.
const INSTANT_S: f64 = 0.0101;

/// The first steps of a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FirstSteps {
    /// Number of agents that begin with the left foot.
    pub left: usize,
    /// Number of agents that begin with the right foot.
    pub right: usize,
    /// Greatest number of agents that lift the same foot within 10 ms.
    pub together: usize,
    /// Time between the tenth and the ninetieth percentile of the first steps, s; none without steps.
    pub spread_s: Option<f64>,
}

/// Side and time of each first step.
#[derive(Clone, Debug, Default)]
pub(crate) struct FirstStepTally {
    /// `[left, right]`, s.
    times_s: [Vec<f64>; 2],
}

impl FirstStepTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let begins = track.start_s == 0.0 && track.samples.first().is_some_and(|sample| sample.stands_on_both_feet());
        let lifts = track.samples.iter().position(|sample| !sample.stands_on_both_feet());
        if let Some(index) = lifts.filter(|_| begins) {
            let side = usize::from(track.samples[index].planted[0]);
            self.times_s[side].push(track.time_s(index));
        }
    }

    /// The first steps of all bodies.
    pub(crate) fn finish(&self) -> FirstSteps {
        let [left, right] = &self.times_s;
        let all_s = || left.iter().chain(right).copied();
        let [early_s, late_s] = [0.1, 0.9].map(|share| percentile(all_s(), share));
        FirstSteps {
            left: left.len(),
            right: right.len(),
            together: self.times_s.iter().map(|times_s| most_together(times_s)).max().unwrap_or_default(),
            spread_s: late_s.zip(early_s).map(|(late_s, early_s)| late_s - early_s),
        }
    }
}

/// Greatest number of times within an instant.
fn most_together(times_s: &[f64]) -> usize {
    let with = |from_s: &f64| times_s.iter().filter(|time_s| (*from_s..=from_s + INSTANT_S).contains(*time_s)).count();
    times_s.iter().map(with).max().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn sides_and_times_of_first_steps() {
        let mut tally = FirstStepTally::default();
        for (side, lift_s) in [(0, 0.5), (0, 0.5), (0, 0.7), (1, 0.5), (1, 1.0)] {
            tally.add(&track(2.0, |time_s, sample| sample.planted[side] = time_s < lift_s - 1e-6));
        }
        tally.add(&track(2.0, |_, _| ()));
        let found = tally.finish();
        assert_eq!((found.left, found.right, found.together), (3, 2, 2));
        assert!((found.spread_s.unwrap() - 0.5).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn bodies_that_begin_in_a_step_do_not_count() {
        let mut tally = FirstStepTally::default();
        tally.add(&track(2.0, |_, sample| sample.planted = [true, false]));
        assert_eq!(tally.finish(), FirstSteps::default());
    }
}

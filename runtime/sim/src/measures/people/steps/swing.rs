//! Swings of small steps: how high a foot is lifted, and for how long.
//!
//! A swing lasts from the last frame in which a foot is planted to the first in which it is planted again. Its length is
//! the displacement of the ball on the ground. Its clearance is the greatest height of the lowest of heel, ball and toe
//! tip, over the lower of its heights at both ends. m, s.

use std::ops::Range;

use motiondb::statistics::median;
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Lengths of the steps of each class, m.
const CLASSES_M: [Range<f32>; 2] = [0.15..0.3, 0.3..0.6];
/// Longest swing that counts, s.
const SWING_MAX_S: f64 = 3.0;

/// The swings of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SwingClass {
    /// Least and greatest length of the steps, m.
    pub lengths_m: [f32; 2],
    /// Number of swings.
    pub count: usize,
    /// Median clearance, cm; none without swings.
    pub clearance_cm: Option<f64>,
    /// Median duration, s; none without swings.
    pub duration_s: Option<f64>,
}

/// Clearance (cm) and duration (s) of every swing of each class.
#[derive(Clone, Debug, Default)]
pub(crate) struct SwingTally {
    classes: [Vec<[f64; 2]>; 2],
}

impl SwingTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        for side in 0..2 {
            for swing in swings(track, side) {
                let [from, to] = [&track.samples[swing.start], &track.samples[swing.end]];
                let length_m = from.balls_m[side].distance(to.balls_m[side]);
                let heights_m = || track.samples[swing.clone()].iter().map(|sample| sample.lowest_sole_m[side]);
                let ground_m = from.lowest_sole_m[side].min(to.lowest_sole_m[side]);
                let clearance_cm = 100.0 * f64::from(heights_m().fold(f32::NEG_INFINITY, f32::max) - ground_m);
                let duration_s = swing.len() as f64 * track.dt_s;
                if let Some(class) = CLASSES_M.iter().position(|class| class.contains(&length_m)) {
                    self.classes[class].push([clearance_cm, duration_s]);
                }
            }
        }
    }

    /// The classes.
    pub(crate) fn finish(&self) -> Vec<SwingClass> {
        let class = |(swings, lengths_m): (&Vec<[f64; 2]>, &Range<f32>)| SwingClass {
            lengths_m: [lengths_m.start, lengths_m.end],
            count: swings.len(),
            clearance_cm: median(swings.iter().map(|swing| swing[0])),
            duration_s: median(swings.iter().map(|swing| swing[1])),
        };
        self.classes.iter().zip(&CLASSES_M).map(class).collect()
    }
}

/// The swings of one foot: from the last planted frame to the first planted frame.
pub(crate) fn swings(track: &BodyTrack, side: usize) -> Vec<Range<usize>> {
    let lifted = track.runs(|index| !track.samples[index].planted[side]);
    let whole = lifted.into_iter().filter(|run| run.start > 0 && run.end < track.samples.len());
    whole.map(|run| run.start - 1..run.end).filter(|swing| swing.len() <= track.count(SWING_MAX_S)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn a_swing_has_its_length_height_and_duration() {
        // The left foot moves by 25 cm between 0.5 and 0.8 s and is 2 cm high in the middle, on ground at 1 cm.
        let mut tally = SwingTally::default();
        tally.add(&track(2.0, |time_s, sample| {
            let share = ((time_s - 0.5) / 0.3).clamp(0.0, 1.0);
            sample.planted[0] = !(1e-6..1.0 - 1e-6).contains(&share);
            sample.balls_m[0].x = 0.25 * share as f32;
            sample.lowest_sole_m[0] = 0.01 + 0.08 * (share * (1.0 - share)) as f32;
        }));
        let [short, middle] = tally.finish()[..] else { panic!("two classes") };
        assert_eq!((short.count, middle.count), (1, 0));
        assert!((short.clearance_cm.unwrap() - 2.0).abs() < 0.01, "{short:?}");
        assert!((short.duration_s.unwrap() - 0.3).abs() < 1e-6, "{short:?}");
    }
}

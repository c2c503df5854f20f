//! Cadence at equal speed: how much agents differ in step frequency where their speed is the same.
//!
//! A stride lasts from one landing of a foot to the next; its cadence is two steps over its duration, its speed the
//! displacement of the root over its duration. Straight strides count: the facing turns by less than 20°, at 0.8 to
//! 2.2 m/s. Of all these strides the line ln cadence = a + b · ln speed is fitted; an agent's deviation is the mean
//! distance of its strides from the line. The coefficient of variation is the standard deviation of these over the
//! agents, since ln(1 + x) ≈ x. 1/s, m/s.

use motiondb::statistics::{mean, standard_deviation};
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Speeds of the strides that count, m/s: walks.
const SPEEDS_MPS: std::ops::Range<f64> = 0.8..2.2;
/// Greatest turn in a stride that counts, rad.
const TURN_MAX_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// Durations of a stride, s: a missed landing makes two of one.
const STRIDE_S: std::ops::Range<f64> = 0.5..2.0;
/// Greatest change of speed between the halves of a stride that counts, as a share.
const SPEED_CHANGE: f64 = 0.1;
/// Least number of strides of an agent that counts.
const STRIDES_MIN: usize = 2;
/// Least number of agents for a line.
const AGENTS_MIN: usize = 3;

/// Cadence of a crowd at equal speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CadenceSpread {
    /// Number of agents with at least two straight strides.
    pub agents: usize,
    /// Mean cadence, steps per minute; none without strides.
    pub mean_steps_per_min: Option<f64>,
    /// Coefficient of variation over agents at equal speed; none of fewer than three agents.
    pub variation: Option<f64>,
}

/// The strides of each agent, (ln speed, ln cadence).
#[derive(Clone, Debug, Default)]
pub(crate) struct Cadences {
    agents: Vec<Vec<[f64; 2]>>,
}

impl Cadences {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let strides = strides(track);
        if strides.len() >= STRIDES_MIN {
            self.agents.push(strides);
        }
    }

    /// The spread over all bodies.
    pub(crate) fn finish(&self) -> CadenceSpread {
        let all = || self.agents.iter().flatten();
        CadenceSpread {
            agents: self.agents.len(),
            mean_steps_per_min: mean(all().map(|[_, cadence]| 60.0 * libm::exp(*cadence))),
            variation: if self.agents.len() >= AGENTS_MIN { self.variation() } else { None },
        }
    }

    fn variation(&self) -> Option<f64> {
        let all = || self.agents.iter().flatten();
        let [speed, cadence] = [mean(all().map(|stride| stride[0]))?, mean(all().map(|stride| stride[1]))?];
        let squares: f64 = all().map(|stride| (stride[0] - speed) * (stride[0] - speed)).sum();
        let products: f64 = all().map(|stride| (stride[0] - speed) * (stride[1] - cadence)).sum();
        let slope = if squares > 1e-9 { products / squares } else { 0.0 };
        let off = |stride: &[f64; 2]| stride[1] - cadence - slope * (stride[0] - speed);
        standard_deviation(self.agents.iter().filter_map(|strides| mean(strides.iter().map(off))))
    }
}

/// (ln speed, ln cadence) of each straight stride.
fn strides(track: &BodyTrack) -> Vec<[f64; 2]> {
    let facings_rad = track.facings_rad();
    let samples = &track.samples;
    let mut found = Vec::new();
    for side in 0..2 {
        let lands = |index: &usize| samples[*index].planted[side] && !samples[index - 1].planted[side];
        let landings: Vec<usize> = (1..samples.len()).filter(lands).collect();
        for pair in landings.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let duration_s = (to - from) as f64 * track.dt_s;
            let moved_m = |a: usize, b: usize| f64::from(samples[b].root_m.distance(samples[a].root_m));
            let speed_mps = moved_m(from, to) / duration_s;
            let middle = usize::midpoint(from, to);
            let halves = [(from, middle), (middle, to)].map(|(a, b)| moved_m(a, b) / ((b - a) as f64 * track.dt_s));
            let steady = (halves[0] - halves[1]).abs() < SPEED_CHANGE * speed_mps;
            let straight = (facings_rad[to] - facings_rad[from]).abs() < TURN_MAX_RAD;
            if SPEEDS_MPS.contains(&speed_mps) && STRIDE_S.contains(&duration_s) && straight && steady {
                found.push([libm::log(speed_mps), libm::log(2.0 / duration_s)]);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// A walk with strides of a duration; the feet alternate.
    fn walk(speed_mps: f64, stride_s: f64) -> BodyTrack {
        track(10.0, |time_s, sample| {
            sample.root_m.x = (speed_mps * time_s) as f32;
            let phase = (time_s / stride_s).fract();
            sample.planted = [phase < 0.6, !(0.1..0.5).contains(&phase)];
        })
    }

    fn variation(walks: &[(f64, f64)]) -> CadenceSpread {
        let mut cadences = Cadences::default();
        walks.iter().for_each(|&(speed_mps, stride_s)| cadences.add(&walk(speed_mps, stride_s)));
        cadences.finish()
    }

    #[test]
    fn agents_of_one_cadence_do_not_vary() {
        let found = variation(&[(1.3, 1.0), (1.3, 1.0), (1.3, 1.0)]);
        assert_eq!(found.agents, 3);
        assert!(found.variation.unwrap() < 1e-6 && (found.mean_steps_per_min.unwrap() - 120.0).abs() < 1e-6);
    }

    #[test]
    fn a_fifth_between_neighbours_is_a_tenth_of_variation() {
        // Strides of 0.9, 1 and 1.1 s at one speed: cadences in the ratio 1.11 : 1 : 0.91, standard deviation 10 %.
        let found = variation(&[(1.3, 0.9), (1.3, 1.0), (1.3, 1.1)]).variation.unwrap();
        assert!((found - 0.1).abs() < 0.005, "{found}");
    }

    #[test]
    fn cadence_that_follows_speed_is_no_variation() {
        // Cadence proportional to the speed: strides of 1.2 m.
        let walks = [0.9, 1.2, 1.8].map(|speed_mps| (speed_mps, 1.2 / speed_mps));
        assert!(variation(&walks).variation.unwrap() < 0.005);
    }
}

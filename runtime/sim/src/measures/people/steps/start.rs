//! Starts from rest: how long they take, how hard they push, and whether the trunk leans into them.
//!
//! A start begins with the last frame in which a body rests, the pelvis slower than 5 cm/s for 0.3 s before. It counts
//! if the body then walks: its walking speed v is the median pelvis speed from 1.5 to 2.5 s later, at least 0.8 m/s.
//! The start lasts until the pelvis first has 0.9 v. Its mean acceleration is 0.9 v over that duration, its peak the
//! greatest change of speed in 0.2 s. Lean is how much further forward the trunk (pelvis to neck) is tilted in the
//! start than in the following second of walking, divided by the mean acceleration. s, m/s², degrees.

use motiondb::statistics::{mean, median};
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Speed below which a body rests, m/s.
pub(crate) const REST_MPS: f64 = 0.05;
/// Least duration of a rest, s.
pub(crate) const REST_S: f64 = 0.3;
/// Times after the rest between which the body walks, s.
const WALK_S: [f64; 2] = [1.5, 2.5];
/// Least duration over which the walking speed is taken, s, where the track ends before.
const WALK_MIN_S: f64 = 0.4;
/// Least walking speed, m/s.
pub(crate) const WALK_MPS: f64 = 0.8;
/// Share of the walking speed that ends a start.
pub(crate) const FULL_SHARE: f64 = 0.9;
/// Interval over which the peak acceleration is taken, s.
pub(crate) const PEAK_S: f64 = 0.2;

/// The starts of a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Starts {
    /// Number of starts.
    pub count: usize,
    /// Median duration up to 90 % of the walking speed, s; none without starts.
    pub duration_s: Option<f64>,
    /// Median of the mean acceleration, m/s²; none without starts.
    pub acceleration_mps2: Option<f64>,
    /// Median of the peak acceleration, m/s²; none without starts.
    pub peak_mps2: Option<f64>,
    /// Median lean, degrees per m/s²; none without starts.
    pub lean_deg_per_mps2: Option<f64>,
    /// Share of the starts that play a recorded transition for more than half of their duration; none without starts.
    pub recorded_share: Option<f64>,
}

/// Duration, mean and peak acceleration and lean of every start, and 1 where it plays a recorded transition.
#[derive(Clone, Debug, Default)]
pub(crate) struct StartTally {
    starts: Vec<[f64; 5]>,
}

impl StartTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let speeds_mps = track.pelvis_speeds_mps();
        let rests = track.runs(|index| speeds_mps[index] < REST_MPS);
        let rests = rests.into_iter().filter(|run| run.len() >= track.count(REST_S));
        self.starts.extend(rests.filter_map(|run| start(track, &speeds_mps, run.end - 1)));
    }

    /// The figures of all starts.
    pub(crate) fn finish(&self) -> Starts {
        let middle = |which: usize| median(self.starts.iter().map(|start| start[which]));
        Starts {
            count: self.starts.len(),
            duration_s: middle(0),
            acceleration_mps2: middle(1),
            peak_mps2: middle(2),
            lean_deg_per_mps2: middle(3),
            recorded_share: mean(self.starts.iter().map(|start| start[4])),
        }
    }
}

/// The start after a rest that ends with the frame `rest`.
fn start(track: &BodyTrack, speeds_mps: &[f64], rest: usize) -> Option<[f64; 5]> {
    let [from, to] = WALK_S.map(|time_s| rest + track.count(time_s));
    let to = to.min(speeds_mps.len());
    let walk_mps = speeds_mps.get(from..to).filter(|walk_mps| walk_mps.len() >= track.count(WALK_MIN_S))?;
    let walking_mps = median(walk_mps.iter().copied()).filter(|speed_mps| *speed_mps >= WALK_MPS)?;
    let full = (rest..to).find(|&index| speeds_mps[index] >= FULL_SHARE * walking_mps)?;
    let duration_s = (full - rest) as f64 * track.dt_s;
    let acceleration_mps2 = FULL_SHARE * walking_mps / duration_s;
    let span = track.count(PEAK_S);
    let gain_mps = |index: usize| speeds_mps[(index + span).min(speeds_mps.len() - 1)] - speeds_mps[index];
    let peak_mps2 = (rest..full).map(gain_mps).fold(0.0, f64::max) / (span as f64 * track.dt_s);
    let tilt_deg = |index: usize| tilt_deg(track, index);
    let starting_deg = mean((rest..full).map(tilt_deg))?;
    let walking_deg = mean((full..(full + track.count(1.0)).min(speeds_mps.len())).map(tilt_deg))?;
    let recorded = (rest..full).filter(|&index| track.samples[index].in_transition).count();
    let is_recorded = f64::from(u8::from(2 * recorded > full - rest));
    Some([duration_s, acceleration_mps2, peak_mps2, (starting_deg - walking_deg) / acceleration_mps2, is_recorded])
}

/// Forward tilt of the trunk in the direction that the body faces, degrees.
fn tilt_deg(track: &BodyTrack, index: usize) -> f64 {
    let sample = &track.samples[index];
    let (sine, cosine) = libm::sincosf(sample.facing_rad);
    let forward_m = sample.trunk_m.x * cosine + sample.trunk_m.y * sine;
    f64::from(libm::atan2f(forward_m, sample.trunk_m.z)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// A body that rests for 1 s, then speeds up by 2 m/s² to 1.4 m/s, its trunk tilted by an angle (rad) meanwhile.
    fn start_with(tilt_rad: f32) -> Starts {
        let mut tally = StartTally::default();
        tally.add(&track(5.0, |time_s, sample| {
            let since_s = (time_s - 1.0).max(0.0);
            let speeding_s = since_s.min(0.7);
            sample.pelvis_m.x = (speeding_s * speeding_s + 1.4 * (since_s - speeding_s)) as f32;
            let tilt_rad = if (0.0..0.63).contains(&(time_s - 1.0)) { tilt_rad } else { 0.05 };
            sample.trunk_m = 0.5 * glam::Vec3::new(libm::sinf(tilt_rad), 0.0, libm::cosf(tilt_rad));
        }));
        tally.finish()
    }

    #[test]
    fn a_start_has_its_duration_and_acceleration() {
        let found = start_with(0.05);
        assert_eq!(found.count, 1);
        // 0.9 · 1.4 m/s at 2 m/s²; rest ends at 5 cm/s.
        assert!((found.duration_s.unwrap() - 0.62).abs() < 0.04, "{found:?}");
        assert!((found.acceleration_mps2.unwrap() - 2.0).abs() < 0.15, "{found:?}");
        assert!((found.peak_mps2.unwrap() - 2.0).abs() < 0.05, "{found:?}");
        assert!(found.lean_deg_per_mps2.unwrap().abs() < 0.01, "{found:?}");
    }

    #[test]
    fn lean_is_measured_against_the_walk() {
        let found = start_with(0.05 + 2_f32.to_radians());
        assert!((found.lean_deg_per_mps2.unwrap() - 1.0).abs() < 0.15, "{found:?}");
    }

    #[test]
    fn a_shift_of_weight_is_no_start() {
        let mut tally = StartTally::default();
        tally.add(&track(5.0, |time_s, sample| sample.pelvis_m.x = 0.4 * time_s.clamp(1.0, 1.5) as f32));
        assert_eq!(tally.finish(), Starts::default());
    }
}

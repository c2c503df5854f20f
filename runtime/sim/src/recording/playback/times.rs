//! Times of a sequence's frames, and the recorded frames of a time. Seconds.

use crate::recording::reader::Recording;
use crate::scenario::{FrameRate, Scenario, ShotSpec};

/// Distance of a time from a recorded frame up to which that frame is shown unchanged, steps.
const SAME_FRAME_STEPS: f64 = 1e-3;

/// Times and numbers of the frames of a sequence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTimes {
    /// Number of the first frame.
    pub first_frame: u32,
    /// Time of the first frame, s.
    pub start_s: f64,
    /// Frame rate.
    pub rate: FrameRate,
}

impl FrameTimes {
    /// The frames of a shot of a scenario.
    pub fn of(shot: &ShotSpec, scenario: &Scenario) -> Self {
        let rate = FrameRate::of(shot.fps.unwrap_or(scenario.view.frame_rate_hz));
        Self { first_frame: shot.first_frame, start_s: f64::from(shot.preroll_s), rate }
    }

    /// Number of frames up to a time; none where the first one is later.
    pub fn count(&self, end_s: f64) -> u32 {
        let shown_s = end_s - self.start_s;
        let frames = shown_s * self.rate.hz() + SAME_FRAME_STEPS;
        if frames < 0.0 { 0 } else { frames as u32 + 1 }
    }

    /// Times that a frame of a shot blends, s, around its own time; that alone where frames are sharp. No time lies outside
    /// the recording, which ends at `end_s`.
    pub fn moments_s(&self, number: u32, shot: &ShotSpec, end_s: f64) -> Vec<f64> {
        let (time_s, count) = (self.time_s(number), shot.samples_per_frame.max(1));
        if count == 1 {
            return vec![time_s];
        }
        let open_s = f64::from(shot.shutter_deg) / 360.0 / self.rate.hz();
        let shift = |moment: u32| (f64::from(moment) + 0.5) / f64::from(count) - 0.5;
        (0..count).map(|moment| (time_s + open_s * shift(moment)).clamp(0.0, end_s)).collect()
    }

    /// Time of a frame, by its number, s.
    pub fn time_s(&self, number: u32) -> f64 {
        self.start_s + self.rate.time_s(number - self.first_frame)
    }
}

/// Time of a recording's last frame, s.
pub fn duration_s(recording: &Recording) -> f64 {
    recording.frame_count().saturating_sub(1) as f64 * f64::from(recording.header().scenario.dt_s)
}

/// The recorded frames of a time.
pub(crate) struct Between {
    /// The frame of the time, or the one before it.
    pub(crate) frame: usize,
    /// The frame after it, and its share; none at a recorded frame.
    pub(crate) later: Option<(usize, f32)>,
}

/// The recorded frames of a time, s.
pub(crate) fn between(recording: &Recording, time_s: f64) -> Between {
    let step = time_s / f64::from(recording.header().scenario.dt_s);
    let nearest = step.round();
    let last = recording.frame_count().saturating_sub(1);
    if (step - nearest).abs() < SAME_FRAME_STEPS || step >= last as f64 {
        return Between { frame: (nearest as usize).min(last), later: None };
    }
    Between { frame: step as usize, later: Some((step as usize + 1, step.fract() as f32)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_counted_and_timed_from_the_end_of_the_preroll() {
        let times = FrameTimes { first_frame: 101, start_s: 0.5, rate: FrameRate::of(24.0) };
        assert_eq!((times.count(2.5), times.count(0.5), times.count(0.4)), (49, 1, 0));
        assert_eq!(times.time_s(101 + 24), 1.5);
        let shot = ShotSpec { samples_per_frame: 2, shutter_deg: 180.0, ..ShotSpec::default() };
        let [first, second] = times.moments_s(101, &shot, 9.0)[..] else { panic!("two moments") };
        assert!((first - (0.5 - 1.0 / 192.0)).abs() < 1e-12 && (second - (0.5 + 1.0 / 192.0)).abs() < 1e-12);
    }
}

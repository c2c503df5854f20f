//! One stride of a clip: between two landmarks of one foot, with exactly one landmark of the other foot between them.
//!
//! A landmark is a mid-stance: the middle of a contact, when the foot is under the body. A stride may begin with either
//! foot. Three landmarks make no stride of a gait where the period is too long or too short, the half-strides too
//! unequal, the body stops between steps, treads in place, or ends in another pose than it began with. Times in frames
//! of the clip; world frame: metres, radians.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use glam::DQuat;
use motiondb::body::Side;

use crate::gait::body_track::BodyTrack;
use crate::ground::root_arc::{RootArc, RootSample};

/// Period of a stride, s: sprints 0.45, captured shuffles 2.2, sneaking and drawn-out styles up to 4.
const PERIOD_S: RangeInclusive<f64> = 0.4..=4.2;
/// Share of the period from the first landmark to the second; real clips have 0.40–0.60.
const HALF_SHARE: RangeInclusive<f64> = 0.32..=0.68;
/// Greatest share of a stride with both feet on the ground; more means a stop. Very slow walking: 0.36 (Schwartz et al.
/// 2008).
const DOUBLE_SUPPORT_MAX: f64 = 0.45;
/// Least travel of a stride that does not turn, m; less is treading in place.
const STRIDE_TRAVEL_M: f64 = 0.05;
/// Least turn of a stride that does not travel, rad: 10°.
const STRIDE_TURN_RAD: f64 = 10.0 * PI / 180.0;
/// Greatest gap between the poses at both ends of a stride, m; steps of humans leave 1 to 6 cm.
pub(crate) const STRIDE_GAP_M: f64 = 0.1;
/// Samples of a stride's root, uniform in time.
const ROOT_SAMPLES: usize = 64;

/// Mid-stance of one foot: the middle of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Landmark {
    /// The foot.
    pub side: Side,
    /// Frame of the clip; it may lie between frames.
    pub frame: f64,
}

/// One whole stride of a clip.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stride {
    /// Frame of phase 0 (right mid-stance); before the stride's first landmark where that is a left one.
    pub zero_frame: f64,
    /// Phase at which the stride begins: 0 (right mid-stance) or ½ (left mid-stance).
    pub start_phase: f64,
    /// Duration of the stride, frames.
    pub period_frames: f64,
    /// Share h of the period from right to left mid-stance.
    pub left_share: f64,
    /// Path of the root; its time 0 is the frame of phase 0.
    pub arc: RootArc,
    /// Least and greatest speed of the hips over half the period, wherever it begins, m/s: alike in a steady gait, far
    /// apart where the body stops, or turns back, within the stride.
    pub half_speeds_mps: [f64; 2],
    /// Rate of change of the facing in the first and in the second step, rad/s.
    pub step_turn_rates_rad_s: [f64; 2],
    /// Root mean square distance of the joints between both ends of the stride, relative to the root, m.
    pub gap_m: f64,
}

/// The stride over three landmarks, if it is one. `stepping` states for each foot whether it is on the ground at a
/// frame.
pub(crate) fn valid_stride(marks: &[Landmark], stepping: &[Vec<bool>; 2], body: &BodyTrack) -> Option<Stride> {
    let [first, middle, last] = marks else { return None };
    let period_frames = last.frame - first.frame;
    let half_share = (middle.frame - first.frame) / period_frames;
    let alternates = first.side == last.side && first.side != middle.side;
    let in_range = PERIOD_S.contains(&(period_frames / body.frame_rate_hz)) && HALF_SHARE.contains(&half_share);
    if !alternates || !in_range || pauses(stepping, first.frame, last.frame) {
        return None;
    }
    let stride = Stride::over(&[*first, *middle, *last], body);
    (travels_or_turns(&stride, body) && stride.gap_m < STRIDE_GAP_M).then_some(stride)
}

impl Stride {
    /// The stride over three landmarks of which the middle one is the other foot's.
    pub(crate) fn over([first, middle, last]: &[Landmark; 3], body: &BodyTrack) -> Self {
        let period_frames = last.frame - first.frame;
        let half_share = (middle.frame - first.frame) / period_frames;
        let (zero_frame, start_phase, left_share) = match first.side {
            Side::Right => (first.frame, 0.0, half_share),
            Side::Left => (middle.frame - period_frames, 0.5, 1.0 - half_share),
        };
        let samples = root_samples(body, first.frame, period_frames);
        let from_start = RootArc::fit(&samples);
        let arc = from_start.shifted((zero_frame - first.frame) / body.frame_rate_hz);
        let steps = [[first, middle], [middle, last]].map(|[from, to]| {
            (body.root_at(from.frame, 0.0), body.root_at(to.frame, 0.0), body.frame_rate_hz / (to.frame - from.frame))
        });
        let step_turn_rates_rad_s = steps.map(|(from, to, per_s)| (to.facing_rad - from.facing_rad) * per_s);
        let mut stride = Self {
            zero_frame,
            start_phase,
            period_frames,
            left_share,
            arc,
            half_speeds_mps: half_speeds_mps(&samples),
            step_turn_rates_rad_s,
            gap_m: 0.0,
        };
        stride.gap_m = gap_m(&stride, body);
        stride
    }

    /// The three landmarks of the stride.
    pub fn landmarks(&self) -> [Landmark; 3] {
        let side = if self.start_phase == 0.0 { Side::Right } else { Side::Left };
        let landmark = |side: Side, frame: f64| Landmark { side, frame };
        [
            landmark(side, self.first_frame()),
            landmark(side.other(), self.middle_frame()),
            landmark(side, self.last_frame()),
        ]
    }

    /// Frame of the first landmark.
    pub fn first_frame(&self) -> f64 {
        if self.start_phase == 0.0 { self.zero_frame } else { self.zero_frame + self.left_share * self.period_frames }
    }

    /// Frame of the last landmark, of the same foot as the first.
    pub fn last_frame(&self) -> f64 {
        self.first_frame() + self.period_frames
    }

    /// Frame of the other foot's landmark.
    pub fn middle_frame(&self) -> f64 {
        self.zero_frame + self.period_frames * if self.start_phase == 0.0 { self.left_share } else { 1.0 }
    }
}

/// The root over a stride; time 0 is the stride's first frame.
fn root_samples(body: &BodyTrack, first_frame: f64, period_frames: f64) -> Vec<RootSample> {
    (0..=ROOT_SAMPLES)
        .map(|sample| {
            let frames = period_frames * sample as f64 / ROOT_SAMPLES as f64;
            body.root_at(first_frame + frames, frames / body.frame_rate_hz)
        })
        .collect()
}

/// Least and greatest speed of the hips over half of the samples, m/s.
fn half_speeds_mps(samples: &[RootSample]) -> [f64; 2] {
    let half = samples.len() / 2;
    let speeds_mps = samples
        .iter()
        .zip(&samples[half..])
        .map(|(from, to)| from.hips_m.distance(to.hips_m) / (to.time_s - from.time_s));
    speeds_mps.fold([f64::INFINITY, 0.0], |[least, greatest], speed| [least.min(speed), greatest.max(speed)])
}

/// Root mean square distance of the joints between the frames nearest to both ends of a stride, in the root frame, m.
fn gap_m(stride: &Stride, body: &BodyTrack) -> f64 {
    let first_frame = stride.first_frame();
    let local = |frame: f64| {
        let index = ((frame + 0.5) as usize).min(body.frame_count() - 1);
        let (position_m, facing_rad) = stride.arc.at((index as f64 - stride.zero_frame) / body.frame_rate_hz);
        let turn = DQuat::from_rotation_z(-facing_rad);
        body.joints(index).positions_m.map(|joint| turn * (joint - position_m.extend(0.0)))
    };
    let (first, last) = (local(first_frame), local(first_frame + stride.period_frames));
    let squares: f64 = first.iter().zip(&last).map(|(a, b)| a.distance_squared(*b)).sum();
    (squares / first.len() as f64).sqrt()
}

fn travels_or_turns(stride: &Stride, body: &BodyTrack) -> bool {
    let (rates, period_s) = (stride.arc.rates, stride.period_frames / body.frame_rate_hz);
    libm::hypot(rates.speed_mps, rates.strafe_mps) * period_s > STRIDE_TRAVEL_M
        || rates.turn_rate_rad_s.abs() * period_s > STRIDE_TURN_RAD
}

/// Whether both feet are on the ground for too large a share of the frames.
fn pauses(stepping: &[Vec<bool>; 2], from: f64, to: f64) -> bool {
    let both = (from as usize..to as usize).filter(|&frame| stepping[0][frame] && stepping[1][frame]).count();
    both as f64 > DOUBLE_SUPPORT_MAX * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn halves_of_a_pivot_differ_in_speed() {
        // 1 m/s ahead and sway; then the same, but back from the middle on.
        let halves = |turns_back: bool| {
            let sample = |k: usize| {
                let time_s = k as f64 / ROOT_SAMPLES as f64;
                let ahead_m = if turns_back && time_s > 0.5 { 1.0 - time_s } else { time_s };
                let hips_m = DVec2::new(ahead_m, 0.03 * libm::sin(2.0 * PI * time_s));
                RootSample { time_s, hips_m, facing_rad: 0.0 }
            };
            half_speeds_mps(&(0..=ROOT_SAMPLES).map(sample).collect::<Vec<_>>())
        };
        let [least_mps, greatest_mps] = halves(false);
        assert!(least_mps > 0.99 && greatest_mps < 1.02, "{least_mps} to {greatest_mps} m/s");
        let [least_mps, greatest_mps] = halves(true);
        assert!(least_mps < 0.2 && greatest_mps > 0.9, "{least_mps} to {greatest_mps} m/s");
    }
}

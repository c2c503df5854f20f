//! One stride of a clip: between two landmarks of one foot, with exactly one of the other foot between them, from
//! either foot.
//!
//! What is no step of a gait is no stride: too long or short, limping beyond measure, stopping between steps, treading
//! on the spot, or ending in another pose than it began with. Times are in frames of the clip.

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

use glam::{DQuat, DVec2};
use motiondb::body::Side;

use crate::ground::arc::{Arc, RootSample};
use crate::retarget::human_clip::HumanJoints;

/// A stride takes this long: sprints 0.45 s, the slowest shuffles 2.2 s.
const PERIOD_S: RangeInclusive<f64> = 0.4..=2.5;
/// Share of the period from the first landmark to the second: real clips .40–.60, for nobody's half-strides are quite
/// equal.
const HALF_SHARE: RangeInclusive<f64> = 0.32..=0.68;
/// Both feet on the ground for a larger share of a stride: the body stops between steps. Very slow walking: 36 %
/// (Schwartz et al. 2008).
const DOUBLE_SUPPORT_MAX: f64 = 0.45;
/// A stride that neither goes nor turns this far treads on the spot, which is no locomotion: metres, 10°.
const STRIDE_TRAVEL_M: f64 = 0.05;
const STRIDE_TURN_RAD: f64 = 10.0 * PI / 180.0;
/// A stride leaves less open than this; steps of real people: 1 to 6 cm.
pub(crate) const STRIDE_GAP_M: f64 = 0.1;
/// Samples of a stride's root, uniform in time.
const ROOT_SAMPLES: usize = 64;

/// The middle of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Landmark {
    /// Whose.
    pub side: Side,
    /// When.
    pub frame: f64,
}

/// One whole stride of a clip.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stride {
    /// Frame of phase 0; before the stride's first landmark where that is a left one.
    pub zero_frame: f64,
    /// The phase at which the stride begins: 0 or ½.
    pub start_phase: f64,
    /// Frames of the stride.
    pub period_frames: f64,
    /// h: share of the period from right to left mid-stance.
    pub left_share: f64,
    /// Its root; time 0 is the frame of phase 0.
    pub arc: Arc,
    /// Speed of the hips in its first and its second step, m/s.
    pub step_speeds_mps: [f64; 2],
    /// Change of the facing in its first and its second step, rad/s.
    pub step_turn_rates_rad_s: [f64; 2],
    /// Root mean square distance of the joints between both its ends, relative to the root: what it leaves open, m.
    pub gap_m: f64,
}

/// Where the body is, frame by frame.
#[derive(Clone, Debug)]
pub struct BodyTrack {
    /// Frames a second.
    pub frame_rate_hz: f64,
    /// Every joint in the world.
    pub joints: Vec<HumanJoints>,
    /// Midpoint of the hips on the ground.
    pub hips_m: Vec<DVec2>,
    /// Facing, unwrapped.
    pub facing_rad: Vec<f64>,
}

impl BodyTrack {
    /// Of all frames.
    pub fn of(joints: Vec<HumanJoints>, frame_rate_hz: f64) -> Self {
        let mut facing_rad: Vec<f64> = joints.iter().map(HumanJoints::facing_rad).collect();
        for frame in 1..facing_rad.len() {
            let step = facing_rad[frame] - facing_rad[frame - 1];
            facing_rad[frame] -= TAU * libm::round(step / TAU);
        }
        let hips_m = joints.iter().map(|joints| joints.hips_m().truncate()).collect();
        Self { frame_rate_hz, joints, hips_m, facing_rad }
    }

    /// Mean speed of the hips, m/s.
    pub fn mean_speed_mps(&self) -> f64 {
        let path: f64 = self.hips_m.windows(2).map(|pair| pair[1].distance(pair[0])).sum();
        path * self.frame_rate_hz / (self.hips_m.len().max(2) - 1) as f64
    }

    /// Mean speed of all joints, m/s.
    pub fn mean_joint_speed_mps(&self) -> f64 {
        let path: f64 = self.joints.windows(2).map(|pair| pair[0].mean_distance_m(&pair[1])).sum();
        path * self.frame_rate_hz / (self.joints.len().max(2) - 1) as f64
    }

    /// From the first frame to the last as the crow flies, m/s.
    pub fn net_speed_mps(&self) -> f64 {
        let (first, last) = (self.hips_m[0], self.hips_m[self.hips_m.len() - 1]);
        first.distance(last) * self.frame_rate_hz / self.hips_m.len() as f64
    }

    /// Between frames, linearly.
    fn at(&self, frame: f64, time_s: f64) -> RootSample {
        let base = (frame.max(0.0) as usize).min(self.hips_m.len() - 2);
        let share = frame - base as f64;
        let facing_rad = self.facing_rad[base] + share * (self.facing_rad[base + 1] - self.facing_rad[base]);
        RootSample { time_s, hips_m: self.hips_m[base].lerp(self.hips_m[base + 1], share), facing_rad }
    }
}

/// The stride over three landmarks, if it is one.
pub(crate) fn stride(marks: &[Landmark], stepping: &[Vec<bool>; 2], body: &BodyTrack) -> Option<Stride> {
    let [first, middle, last] = marks else { return None };
    let period_frames = last.frame - first.frame;
    let half_share = (middle.frame - first.frame) / period_frames;
    let alternates = first.side == last.side && first.side != middle.side;
    let in_range = PERIOD_S.contains(&(period_frames / body.frame_rate_hz)) && HALF_SHARE.contains(&half_share);
    if !alternates || !in_range || pauses(stepping, first.frame, last.frame) {
        return None;
    }
    let stride = Stride::over(&[*first, *middle, *last], body);
    (goes_somewhere(&stride, body) && stride.gap_m < STRIDE_GAP_M).then_some(stride)
}

impl Stride {
    /// The stride over three landmarks of which the middle one is the other foot's.
    pub fn over([first, middle, last]: &[Landmark; 3], body: &BodyTrack) -> Self {
        let period_frames = last.frame - first.frame;
        let half_share = (middle.frame - first.frame) / period_frames;
        let (zero_frame, start_phase, left_share) = match first.side {
            Side::Right => (first.frame, 0.0, half_share),
            Side::Left => (middle.frame - period_frames, 0.5, 1.0 - half_share),
        };
        let arc = arc(body, first.frame, period_frames).shifted((zero_frame - first.frame) / body.frame_rate_hz);
        let steps = [[first, middle], [middle, last]].map(|[from, to]| {
            (body.at(from.frame, 0.0), body.at(to.frame, 0.0), body.frame_rate_hz / (to.frame - from.frame))
        });
        let step_speeds_mps = steps.map(|(from, to, per_s)| from.hips_m.distance(to.hips_m) * per_s);
        let step_turn_rates_rad_s = steps.map(|(from, to, per_s)| (to.facing_rad - from.facing_rad) * per_s);
        let mut stride = Self {
            zero_frame,
            start_phase,
            period_frames,
            left_share,
            arc,
            step_speeds_mps,
            step_turn_rates_rad_s,
            gap_m: 0.0,
        };
        stride.gap_m = gap_m(&stride, body);
        stride
    }

    /// The landmarks that it lies between.
    pub fn landmarks(&self) -> [Landmark; 3] {
        let side = if self.start_phase == 0.0 { Side::Right } else { Side::Left };
        let landmark = |side: Side, frame: f64| Landmark { side, frame };
        [
            landmark(side, self.first_frame()),
            landmark(side.other(), self.middle_frame()),
            landmark(side, self.last_frame()),
        ]
    }

    /// Its first landmark.
    pub fn first_frame(&self) -> f64 {
        if self.start_phase == 0.0 { self.zero_frame } else { self.zero_frame + self.left_share * self.period_frames }
    }

    /// Its last landmark, of the same foot.
    pub fn last_frame(&self) -> f64 {
        self.first_frame() + self.period_frames
    }

    /// The other foot's landmark.
    pub fn middle_frame(&self) -> f64 {
        self.zero_frame + self.period_frames * if self.start_phase == 0.0 { self.left_share } else { 1.0 }
    }
}

/// The arc of a stride, its clock at 0 at the stride's first frame.
fn arc(body: &BodyTrack, first_frame: f64, period_frames: f64) -> Arc {
    let samples: Vec<RootSample> = (0..=ROOT_SAMPLES)
        .map(|sample| {
            let frames = period_frames * sample as f64 / ROOT_SAMPLES as f64;
            body.at(first_frame + frames, frames / body.frame_rate_hz)
        })
        .collect();
    Arc::fit(&samples)
}

/// How far the body is at the end of a stride from where it was at its beginning.
fn gap_m(stride: &Stride, body: &BodyTrack) -> f64 {
    let first_frame = stride.first_frame();
    let local = |frame: f64| {
        let index = ((frame + 0.5) as usize).min(body.joints.len() - 1);
        let (position_m, facing_rad) = stride.arc.at((index as f64 - stride.zero_frame) / body.frame_rate_hz);
        let turn = DQuat::from_rotation_z(-facing_rad);
        body.joints[index].positions_m.map(|joint| turn * (joint - position_m.extend(0.0)))
    };
    let (first, last) = (local(first_frame), local(first_frame + stride.period_frames));
    let squares: f64 = first.iter().zip(&last).map(|(a, b)| a.distance_squared(*b)).sum();
    (squares / first.len() as f64).sqrt()
}

fn goes_somewhere(stride: &Stride, body: &BodyTrack) -> bool {
    let (rates, period_s) = (stride.arc.rates, stride.period_frames / body.frame_rate_hz);
    libm::hypot(rates.speed_mps, rates.strafe_mps) * period_s > STRIDE_TRAVEL_M
        || rates.turn_rate_rad_s.abs() * period_s > STRIDE_TURN_RAD
}

/// Whether both feet stay down too long for a gait.
fn pauses(stepping: &[Vec<bool>; 2], from: f64, to: f64) -> bool {
    let both = (from as usize..to as usize).filter(|&frame| stepping[0][frame] && stepping[1][frame]).count();
    both as f64 > DOUBLE_SUPPORT_MAX * (to - from)
}

//! A body that stands → GaitCycle without steps: both feet planted, the root at rest ([`resting_arc`]).
//!
//! The period is that of m_sp, so that standing and walking share one clock (definition "Example" of
//! `docs/definitions.md`). The calmest of all windows of that length is used: the one whose ends are most alike, and
//! closed like a stride. Times in frames of the clip; world frame in, root frame out: metres, seconds, radians.

use std::collections::VecDeque;
use std::ops::Range;

use glam::{DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::statistics::mean;

use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::mean_stride::mean_stride;
use crate::gait::foot_stance::FootStance;
use crate::gait::stride::Stride;
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::root_arc::{Rates, RootArc};
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// Weight of a joint's velocity beside its position where poses are compared, s.
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// The calmest cycle of frames in which a clip stands. Frames shorter than the period are played slower.
pub(crate) fn standing_cycle(clip: &GroundedClip, body: &HumanBody, frames: Range<usize>, period_s: f64) -> GaitCycle {
    let length = ((period_s * clip.frame_rate_hz) as usize).clamp(1, frames.len() - 1);
    let first = calmest_start(clip, body, frames, length);
    let joints: Vec<HumanJoints> =
        (first..first + length).map(|frame| clip.pose(frame).forward_kinematics(body)).collect();
    let stride = Stride {
        zero_frame: first as f64,
        period_frames: (period_s * clip.frame_rate_hz).min(length as f64),
        left_share: 0.5,
        arc: resting_arc(&joints),
        ..Stride::default()
    };
    let mut cycle = mean_stride(clip, body, &[vec![FootStance::ALWAYS], vec![FootStance::ALWAYS]], &[stride]);
    cycle.phase_map.period_s = period_s as f32;
    cycle.steps = false;
    cycle
}

/// First frame of the calmest window of so many frames; of several the first.
fn calmest_start(clip: &GroundedClip, body: &HumanBody, frames: Range<usize>, length: usize) -> usize {
    let mut near = PositionsNear { before: 0, positions_m: VecDeque::new() };
    let mut calmest: Option<(f64, usize)> = None;
    for start in 0..frames.len() - length {
        near.forget_before(start.saturating_sub(1));
        while near.end() < (start + length + 2).min(frames.len()) {
            let pose = clip.pose(frames.start + near.end());
            near.positions_m.push_back(pose.forward_kinematics(body).positions_m);
        }
        let unrest_m = near.unrest_m(start, length, clip.frame_rate_hz);
        if calmest.is_none_or(|(least_m, _)| unrest_m.total_cmp(&least_m).is_lt()) {
            calmest = Some((unrest_m, start));
        }
    }
    frames.start + calmest.map_or(0, |(_, start)| start)
}

/// Positions of the joints in the frames about a window, counted from the first of the frames in which a body stands.
struct PositionsNear {
    /// Number of frames before those that are held.
    before: usize,
    /// Positions, m.
    positions_m: VecDeque<[DVec3; JOINT_COUNT]>,
}

impl PositionsNear {
    /// The frame after the last that is held.
    fn end(&self) -> usize {
        self.before + self.positions_m.len()
    }

    fn forget_before(&mut self, frame: usize) {
        while self.before < frame && self.positions_m.pop_front().is_some() {
            self.before += 1;
        }
    }

    fn at(&self, frame: usize) -> &[DVec3; JOINT_COUNT] {
        &self.positions_m[frame - self.before]
    }

    /// Distance of the poses at both ends of a window, in position and in velocity, summed over the joints, m.
    fn unrest_m(&self, start: usize, length: usize, frame_rate_hz: f64) -> f64 {
        let end = start + length;
        let velocity_mps = |frame: usize, joint: usize| {
            let (before, after) = (frame.saturating_sub(1), (frame + 1).min(self.end() - 1));
            (self.at(after)[joint] - self.at(before)[joint]) * (frame_rate_hz / (after - before) as f64)
        };
        (0..JOINT_COUNT)
            .map(|joint| {
                let distance_m = self.at(end)[joint].distance(self.at(start)[joint]);
                distance_m + VELOCITY_WEIGHT_S * velocity_mps(end, joint).distance(velocity_mps(start, joint))
            })
            .sum()
    }
}

/// The root of a body that stands: to the side between the ankles, whichever leg bears the weight, and ahead under the
/// hips; on average over its poses.
pub(crate) fn resting_arc(joints: &[HumanJoints]) -> RootArc {
    let mean_m =
        |point_m: &dyn Fn(&HumanJoints) -> DVec3| mean(joints.iter().map(point_m)).unwrap_or_default().truncate();
    let hips_m = mean_m(&HumanJoints::hips_m);
    let ankles_m = mean_m(&|joints| 0.5 * Joint::FEET.map(|foot| joints.position_m(foot)).into_iter().sum::<DVec3>());
    let facing_rad = mean_facing_rad(joints);
    let (sin, cos) = libm::sincos(facing_rad);
    let left = DVec2::new(-sin, cos);
    RootArc { start_m: hips_m + left * left.dot(ankles_m - hips_m), facing_rad, rates: Rates::default() }
}

/// Direction of the mean of all facing vectors, rad.
fn mean_facing_rad(window: &[HumanJoints]) -> f64 {
    let sum: DVec2 = window
        .iter()
        .map(|joints| {
            let (sin, cos) = libm::sincos(joints.facing_rad());
            DVec2::new(cos, sin)
        })
        .sum();
    libm::atan2(sum.y, sum.x)
}

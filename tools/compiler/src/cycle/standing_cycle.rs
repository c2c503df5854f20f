//! A body that stands → GaitCycle without steps: both feet planted, the root at rest.
//!
//! The period is that of m_sp, so that standing and walking share one clock (definition "Example" of
//! `docs/definitions.md`). The calmest of all windows of that length is used: the one whose ends are most alike, and
//! closed like a stride. Times in frames of the clip; world frame in, root frame out: metres, seconds, radians.

use std::ops::Range;

use glam::DVec2;
use motiondb::statistics::mean;

use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::mean_stride::mean_stride;
use crate::gait::foot_stance::FootStance;
use crate::gait::stride::Stride;
use crate::ground::root_arc::{Rates, RootArc};
use crate::ground::root_motion::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// Weight of a joint's velocity beside its position where poses are compared, s.
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// The calmest cycle of frames in which a clip stands. Frames shorter than the period are played slower.
pub(crate) fn standing_cycle(clip: &GroundedClip, body: &HumanBody, frames: Range<usize>, period_s: f64) -> GaitCycle {
    let first = frames.start;
    let joints: Vec<HumanJoints> = clip.poses[frames].iter().map(|pose| pose.forward_kinematics(body)).collect();
    let length = ((period_s * clip.frame_rate_hz) as usize).clamp(1, joints.len() - 1);
    let unrest = |start: &usize| unrest_m(&joints, *start, length, clip.frame_rate_hz);
    let start = (0..joints.len() - length).min_by(|a, b| unrest(a).total_cmp(&unrest(b))).unwrap_or(0);
    let window = &joints[start..start + length];
    let hips_m = mean(window.iter().map(|joints| joints.hips_m().truncate())).unwrap_or_default();
    let stride = Stride {
        zero_frame: (first + start) as f64,
        period_frames: (period_s * clip.frame_rate_hz).min(length as f64),
        left_share: 0.5,
        arc: RootArc { start_m: hips_m, facing_rad: mean_facing_rad(window), rates: Rates::default() },
        ..Stride::default()
    };
    let mut cycle = mean_stride(clip, body, &[vec![FootStance::ALWAYS], vec![FootStance::ALWAYS]], &[stride]);
    cycle.phase_map.period_s = period_s as f32;
    cycle.steps = false;
    cycle
}

/// Distance of the poses at both ends of a window, in position and in velocity, summed over the joints, m.
fn unrest_m(joints: &[HumanJoints], start: usize, length: usize, frame_rate_hz: f64) -> f64 {
    let end = start + length;
    let velocity_mps = |frame: usize, joint: usize| {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(joints.len() - 1));
        (joints[after].positions_m[joint] - joints[before].positions_m[joint])
            * (frame_rate_hz / (after - before) as f64)
    };
    (0..joints[start].positions_m.len())
        .map(|joint| {
            let distance_m = joints[end].positions_m[joint].distance(joints[start].positions_m[joint]);
            distance_m + VELOCITY_WEIGHT_S * velocity_mps(end, joint).distance(velocity_mps(start, joint))
        })
        .sum()
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

//! A clip whose body stands → GaitCycle without steps: both feet planted, the root at rest (`definitions.md`,
//! "Example").
//!
//! Its period is that of m_sp, so that idle and walk share one clock; of all windows of that length the calmest is
//! taken, the one whose ends are most alike, and closed like a stride.

use glam::DVec2;

use crate::arc::{Arc, Rates};
use crate::cycle::{GaitCycle, mean_stride};
use crate::human_clip::{HumanBody, HumanJoints};
use crate::root_motion::GroundedClip;
use crate::stride::Stride;

/// Weight of a joint's velocity beside its place where poses are compared: as far as it gets in this time.
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// The calmest cycle of a standing clip. A clip shorter than the period is played slower.
pub fn standing_cycle(clip: &GroundedClip, body: &HumanBody, period_s: f64) -> GaitCycle {
    let joints: Vec<HumanJoints> = clip.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let length = ((period_s * clip.frame_rate_hz) as usize).clamp(1, joints.len() - 1);
    let start = (0..joints.len() - length)
        .min_by(|a, b| unrest(&joints, *a, length, clip).total_cmp(&unrest(&joints, *b, length, clip)))
        .unwrap_or(0);
    let window = &joints[start..start + length];
    let stride = Stride {
        zero_frame: start as f64,
        start_phase: 0.0,
        period_frames: (period_s * clip.frame_rate_hz).min(length as f64),
        left_share: 0.5,
        arc: Arc { start_m: mean_hips_m(window), facing_rad: mean_facing_rad(window), rates: Rates::default() },
        step_speeds_mps: [0.0; 2],
    };
    let planted = [vec![true; joints.len()], vec![true; joints.len()]];
    let mut cycle = mean_stride(clip, body, &planted, &[stride]);
    cycle.phase_map.period_s = period_s as f32;
    cycle.steps = false;
    cycle
}

/// How unlike the ends of a window are, in place and velocity, summed over the joints; metres.
fn unrest(joints: &[HumanJoints], start: usize, length: usize, clip: &GroundedClip) -> f64 {
    let end = start + length;
    let velocity = |frame: usize, joint: usize| {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(joints.len() - 1));
        (joints[after].positions_m[joint] - joints[before].positions_m[joint])
            * (clip.frame_rate_hz / (after - before) as f64)
    };
    (0..joints[start].positions_m.len())
        .map(|joint| {
            let place = joints[end].positions_m[joint].distance(joints[start].positions_m[joint]);
            place + VELOCITY_WEIGHT_S * velocity(end, joint).distance(velocity(start, joint))
        })
        .sum()
}

fn mean_hips_m(window: &[HumanJoints]) -> DVec2 {
    window.iter().map(|joints| joints.hips_m().truncate()).sum::<DVec2>() / window.len() as f64
}

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

//! A body that stands: where in a clip it does, and its GaitCycle without steps: both feet planted, the root at rest.
//!
//! Its period is that of m_sp, so that idle and walk share one clock; of all windows of that length the calmest is
//! taken, the one whose ends are most alike, and closed like a stride. Times are in frames of the clip.

use std::ops::Range;

use glam::DVec2;

use crate::cycle::mean_stride::{GaitCycle, mean_stride};
use crate::gait::contacts::runs;
use crate::gait::gait_events::Stance;
use crate::gait::stride::{BodyTrack, Stride};
use crate::ground::arc::{Arc, Rates};
use crate::ground::root_motion::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// A body stands that moves slower than this …
const STANDING_SPEED_MPS: f64 = 0.06;
/// … and whose joints move slower than this in the mean: who breathes and shifts weight stands (0.003–0.02), who dances
/// does not.
pub(crate) const STANDING_STIR_MPS: f64 = 0.06;
/// A clip stands as a whole with its feet planted for nearly all of it.
const STANDING_SHARE_MIN: f64 = 0.95;
/// Shorter clips are poses.
pub(crate) const STANDING_MIN_S: f64 = 0.5;
/// Speeds within a capture are taken over this time: a pause between two steps is none of standing.
const REST_SPAN_S: f64 = 0.5;
/// And a body rests in it for this long at least: longer than a stride of m_sp, so that what is left of the step before
/// and comes of the next is not the idle.
const REST_MIN_S: f64 = 1.5;
/// Weight of a joint's velocity beside its place where poses are compared: as far as it gets in this time.
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// Whether the whole clip stands.
pub(crate) fn stands(planted: &[Vec<bool>; 2], track: &BodyTrack) -> bool {
    let share = |side: &Vec<bool>| side.iter().filter(|planted| **planted).count() as f64 / side.len() as f64;
    track.joints.len() as f64 >= STANDING_MIN_S * track.frame_rate_hz
        && track.net_speed_mps() < STANDING_SPEED_MPS
        && track.mean_joint_speed_mps() < STANDING_STIR_MPS
        && planted.iter().all(|side| share(side) >= STANDING_SHARE_MIN)
}

/// The longest rest of a body that goes about, between two frames.
pub(crate) fn longest_rest(planted: &[Vec<bool>; 2], track: &BodyTrack, frames: Range<usize>) -> Option<Range<usize>> {
    let still = still_frames(track);
    let rests: Vec<bool> = frames.clone().map(|frame| planted[0][frame] && planted[1][frame] && still[frame]).collect();
    let long = REST_MIN_S * track.frame_rate_hz;
    runs(&rests)
        .into_iter()
        .filter(|&(rests, start, end)| rests && (end - start) as f64 > long)
        .map(|(_, start, end)| frames.start + start..frames.start + end)
        // The first of the longest: `max_by_key` alone would take the last.
        .rev()
        .max_by_key(ExactSizeIterator::len)
}

/// Whether hips and joints are at rest about each frame.
fn still_frames(track: &BodyTrack) -> Vec<bool> {
    let mut path_m = vec![0.0];
    for pair in track.joints.windows(2) {
        path_m.push(path_m[path_m.len() - 1] + pair[0].mean_distance_m(&pair[1]));
    }
    let half = ((0.5 * REST_SPAN_S * track.frame_rate_hz) as usize).max(1);
    let is_still = |frame: usize| {
        let (before, after) = (frame.saturating_sub(half), (frame + half).min(path_m.len() - 1));
        let span_s = (after - before) as f64 / track.frame_rate_hz;
        path_m[after] - path_m[before] < STANDING_STIR_MPS * span_s
            && track.hips_m[after].distance(track.hips_m[before]) < STANDING_SPEED_MPS * span_s
    };
    (0..path_m.len()).map(is_still).collect()
}

/// The calmest cycle of frames in which a clip stands. Frames shorter than the period are played slower.
pub(crate) fn standing_cycle(clip: &GroundedClip, body: &HumanBody, frames: Range<usize>, period_s: f64) -> GaitCycle {
    let first = frames.start;
    let joints: Vec<HumanJoints> = clip.poses[frames].iter().map(|pose| pose.forward_kinematics(body)).collect();
    let length = ((period_s * clip.frame_rate_hz) as usize).clamp(1, joints.len() - 1);
    let start = (0..joints.len() - length)
        .min_by(|a, b| unrest(&joints, *a, length, clip).total_cmp(&unrest(&joints, *b, length, clip)))
        .unwrap_or(0);
    let window = &joints[start..start + length];
    let stride = Stride {
        zero_frame: (first + start) as f64,
        period_frames: (period_s * clip.frame_rate_hz).min(length as f64),
        left_share: 0.5,
        arc: Arc { start_m: mean_hips_m(window), facing_rad: mean_facing_rad(window), rates: Rates::default() },
        ..Stride::default()
    };
    let mut cycle = mean_stride(clip, body, &[vec![Stance::ALWAYS], vec![Stance::ALWAYS]], &[stride]);
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

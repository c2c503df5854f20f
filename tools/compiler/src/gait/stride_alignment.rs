//! Landmarks finer than frames: every stride of a window begins, and has its middle, where the body is most alike.
//!
//! The middle of a contact is known to half a frame only: at 30 frames per second 2 % of a stride. So each landmark
//! moves to where all joints, relative to hips and facing, are nearest to those at the first landmark of the same foot.
//! The mean move of a foot's landmarks is taken back, since their mean is right. Frames of the clip, metres.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Side};
use motiondb::statistics::mean;

use crate::gait::body_track::BodyTrack;
use crate::gait::stride::{Landmark, Stride};

/// Greatest move of a landmark, s: one frame at 30 frames per second.
const MOVE_MAX_S: f64 = 1.0 / 30.0;
/// Moves that are tried to either side.
const MOVE_STEPS: i32 = 32;

/// The strides of a window, end to end, with their landmarks aligned.
pub(crate) fn aligned_strides(strides: &[Stride], body: &BodyTrack) -> Vec<Stride> {
    let Some(last) = strides.last() else { return Vec::new() };
    let ends: Vec<f64> =
        strides.iter().map(Stride::first_frame).chain([last.first_frame() + last.period_frames]).collect();
    let middles: Vec<f64> = strides.iter().map(Stride::middle_frame).collect();
    let (ends, middles) = (aligned_frames(&ends, body), aligned_frames(&middles, body));
    let side = if last.start_phase == 0.0 { Side::Right } else { Side::Left };
    let landmark = |side: Side, frame: f64| Landmark { side, frame };
    let realigned = |index: usize| {
        let marks =
            [landmark(side, ends[index]), landmark(side.other(), middles[index]), landmark(side, ends[index + 1])];
        Stride::over(&marks, body)
    };
    (0..strides.len()).map(realigned).collect()
}

/// Landmark frames of one foot, each moved to the pose of the first, their mean kept.
fn aligned_frames(frames: &[f64], body: &BodyTrack) -> Vec<f64> {
    // The frame before the first landmark, not the nearest: as far from the last landmark is then still within the
    // clip.
    let first = frames[0] as usize;
    let reference = LocalJoints::between(first as f64, first as f64, body).at(first as f64);
    let moved: Vec<f64> = frames
        .iter()
        .map(|frame| nearest_frame(&reference, first as f64 + frame - frames[0], body) - first as f64 + frames[0])
        .collect();
    let mean_move = mean(moved.iter().zip(frames).map(|(moved, frame)| moved - frame)).unwrap_or(0.0);
    moved.iter().map(|frame| frame - mean_move).collect()
}

/// The frame near `frame` whose pose is nearest to a reference; of several the one that moves least.
fn nearest_frame(reference: &[DVec3; JOINT_COUNT], frame: f64, body: &BodyTrack) -> f64 {
    let step = (MOVE_MAX_S * body.frame_rate_hz).max(1.0) / f64::from(MOVE_STEPS);
    let reach = step * f64::from(MOVE_STEPS);
    let near = LocalJoints::between(frame - reach, frame + reach, body);
    let distance = |frame: f64| {
        let joints = near.at(frame);
        reference.iter().zip(&joints).map(|(a, b)| a.distance_squared(*b)).sum::<f64>()
    };
    let candidates =
        (0..=MOVE_STEPS).flat_map(|steps| [frame + step * f64::from(steps), frame - step * f64::from(steps)]);
    let best = candidates.map(|frame| (distance(frame), frame)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(frame, |(_, frame)| frame)
}

/// Every joint relative to hips and facing in successive frames, m.
struct LocalJoints {
    /// The first of these frames.
    first: usize,
    joints_m: Vec<[DVec3; JOINT_COUNT]>,
}

impl LocalJoints {
    /// The joints in the frames about an interval of fractional frames.
    fn between(from: f64, to: f64, body: &BodyTrack) -> Self {
        let last_base = body.frame_count() - 2;
        let [first, last] = [from, to].map(|frame| (frame.max(0.0) as usize).min(last_base));
        let local = |frame: usize| {
            let turn = DQuat::from_rotation_z(-body.facing_rad[frame]);
            body.joints(frame).positions_m.map(|joint| turn * (joint - body.hips_m[frame].extend(0.0)))
        };
        Self { first, joints_m: (first..last + 2).map(local).collect() }
    }

    /// The joints at a fractional frame of the interval, linearly between frames.
    fn at(&self, frame: f64) -> [DVec3; JOINT_COUNT] {
        let base = (frame.max(0.0) as usize).clamp(self.first, self.first + self.joints_m.len() - 2);
        let share = (frame - base as f64).clamp(0.0, 1.0);
        let [before, after] = [0, 1].map(|next| &self.joints_m[base - self.first + next]);
        std::array::from_fn(|joint| before[joint].lerp(after[joint], share))
    }
}

#[cfg(test)]
mod tests {
    use crate::synthetic::{self, SyntheticWalk};

    #[test]
    fn periods_are_exact_to_a_twentieth_of_a_frame() {
        for period_s in [1.1, 1.117, 1.25] {
            let walk = SyntheticWalk { period_s, frame_rate_hz: 30.0, duration_s: 6.0, ..SyntheticWalk::default() };
            let clip = synthetic::walk("walk", walk);
            for stride in synthetic::strides_of(&clip) {
                assert!((stride.period_frames - 30.0 * period_s).abs() < 0.05, "{stride:?}");
            }
        }
    }
}

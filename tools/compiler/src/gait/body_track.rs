//! Where a body is, frame by frame: its joints, the midpoint of its hips, its facing; and how fast it moves.
//!
//! World frame: metres, seconds, radians, Z up; one value a frame.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::ground::root_arc::RootSample;
use crate::retarget::human_clip::HumanJoints;

/// Positions of a body over a clip.
#[derive(Clone, Debug)]
pub(crate) struct BodyTrack {
    /// Frames per second.
    pub(crate) frame_rate_hz: f64,
    /// Every joint in the world, at each frame.
    pub(crate) joints: Vec<HumanJoints>,
    /// Midpoint of the hips on the ground at each frame, m.
    pub(crate) hips_m: Vec<DVec2>,
    /// Facing at each frame, without jumps of 2π, rad.
    pub(crate) facing_rad: Vec<f64>,
}

impl BodyTrack {
    /// The track of a clip's joints.
    pub(crate) fn of(joints: Vec<HumanJoints>, frame_rate_hz: f64) -> Self {
        let mut facing_rad: Vec<f64> = joints.iter().map(HumanJoints::facing_rad).collect();
        for frame in 1..facing_rad.len() {
            let step_rad = facing_rad[frame] - facing_rad[frame - 1];
            facing_rad[frame] -= TAU * libm::round(step_rad / TAU);
        }
        let hips_m = joints.iter().map(|joints| joints.hips_m().truncate()).collect();
        Self { frame_rate_hz, joints, hips_m, facing_rad }
    }

    /// Mean speed of the hips along their path, m/s.
    pub(crate) fn mean_speed_mps(&self) -> f64 {
        let path_m: f64 = self.hips_m.windows(2).map(|pair| pair[1].distance(pair[0])).sum();
        path_m * self.frame_rate_hz / (self.hips_m.len().max(2) - 1) as f64
    }

    /// Mean speed of all joints along their paths, m/s.
    pub(crate) fn mean_joint_speed_mps(&self) -> f64 {
        let path_m: f64 = self.joints.windows(2).map(|pair| pair[0].mean_distance_m(&pair[1])).sum();
        path_m * self.frame_rate_hz / (self.joints.len().max(2) - 1) as f64
    }

    /// Speed of the hips in a straight line from the first frame to the last, m/s.
    pub(crate) fn net_speed_mps(&self) -> f64 {
        let (first, last) = (self.hips_m[0], self.hips_m[self.hips_m.len() - 1]);
        first.distance(last) * self.frame_rate_hz / self.hips_m.len() as f64
    }

    /// Hips and facing at a fractional frame, linearly between frames, with the time that the caller gives them.
    pub(crate) fn root_at(&self, frame: f64, time_s: f64) -> RootSample {
        let base = (frame.max(0.0) as usize).min(self.hips_m.len() - 2);
        let share = frame - base as f64;
        let facing_rad = self.facing_rad[base] + share * (self.facing_rad[base + 1] - self.facing_rad[base]);
        RootSample { time_s, hips_m: self.hips_m[base].lerp(self.hips_m[base + 1], share), facing_rad }
    }
}

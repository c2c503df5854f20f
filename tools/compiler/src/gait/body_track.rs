//! Where a body is, frame by frame: its joints, the midpoint of its hips, its facing; and how fast it moves.
//!
//! World frame: metres, seconds, radians, Z up; one value a frame.

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::ops::Range;

use glam::DVec2;
use motiondb::body::Joint;

use crate::ground::grounded_clip::GroundedClip;
use crate::ground::root_arc::RootSample;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// Span of the chords by which the length of a joint's path is taken, s: the noise of a capture is no path.
const CHORD_S: f64 = 0.2;

/// Positions of a body over a clip.
pub(crate) struct BodyTrack<'a> {
    clip: &'a GroundedClip<'a>,
    body: &'a HumanBody,
    /// Frames per second.
    pub(crate) frame_rate_hz: f64,
    /// Length of the joints' paths up to each frame, by their chords, mean over the joints, m.
    pub(crate) joint_path_m: Vec<f64>,
    /// Midpoint of the hips on the ground at each frame, m.
    pub(crate) hips_m: Vec<DVec2>,
    /// Facing at each frame, without jumps of 2π, rad.
    pub(crate) facing_rad: Vec<f64>,
    /// Horizontal positions of the ankles at each frame, `[left, right]`, m.
    pub(crate) ankles_m: Vec<[DVec2; 2]>,
}

/// Position and facing of a body over a clip.
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyPath {
    /// Midpoint of the hips on the ground at each frame, m.
    pub(crate) hips_m: Vec<DVec2>,
    /// Facing at each frame, without jumps of 2π, rad.
    pub(crate) facing_rad: Vec<f64>,
}

/// Number of frames over which the length of a joint's path is taken: its chord over [`CHORD_S`].
pub(crate) fn chord_frames(frame_rate_hz: f64) -> usize {
    (libm::round(CHORD_S * frame_rate_hz) as usize).max(1)
}

/// Length of a path up to each frame. A step of it is that of the chord, from frame `chord` to `chord + chord_frames`, whose
/// middle is nearest; `chords_m` are lengths a frame.
fn path_of_chords(chords_m: &[f64], chord_frames: usize, frame_count: usize) -> Vec<f64> {
    let step_m = |frame: usize| {
        let chord = frame.saturating_sub(chord_frames.div_ceil(2)).min(chords_m.len().max(1) - 1);
        chords_m.get(chord).copied().unwrap_or_default()
    };
    let mut path_m = 0.0;
    (0..frame_count)
        .map(|frame| {
            path_m += if frame == 0 { 0.0 } else { step_m(frame) };
            path_m
        })
        .collect()
}

impl<'a> BodyTrack<'a> {
    /// The track of a clip. `see` gets the joints of each frame; they are not kept.
    pub(crate) fn of(clip: &'a GroundedClip<'a>, body: &'a HumanBody, mut see: impl FnMut(&HumanJoints)) -> Self {
        let frame_rate_hz = clip.frame_rate_hz;
        let (joint_path_m, hips_m, facing_rad, ankles_m) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut track = Self { clip, body, frame_rate_hz, joint_path_m, hips_m, facing_rad, ankles_m };
        let chord_frames = chord_frames(frame_rate_hz).min(clip.frame_count().max(2) - 1);
        let (mut before, mut chords_m) = (VecDeque::with_capacity(chord_frames), Vec::new());
        for frame in 0..clip.frame_count() {
            let joints = track.joints(frame);
            see(&joints);
            track.push(&joints);
            if before.len() == chord_frames {
                let first: HumanJoints = before.pop_front().expect("a chord has at least one frame");
                chords_m.push(first.mean_distance_m(&joints) / chord_frames as f64);
            }
            before.push_back(joints);
        }
        track.joint_path_m = path_of_chords(&chords_m, chord_frames, clip.frame_count());
        track
    }

    /// Appends a frame, without the path of its joints.
    fn push(&mut self, joints: &HumanJoints) {
        let facing_rad = joints.facing_rad();
        let jump_rad = self.facing_rad.last().map_or(0.0, |last_rad| facing_rad - last_rad);
        self.hips_m.push(joints.hips_m().truncate());
        self.ankles_m.push(Joint::FEET.map(|foot| joints.positions_m[foot.index()].truncate()));
        self.facing_rad.push(facing_rad - TAU * libm::round(jump_rad / TAU));
    }

    /// Number of frames.
    pub(crate) fn frame_count(&self) -> usize {
        self.hips_m.len()
    }

    /// Every joint in the world at a frame.
    pub(crate) fn joints(&self, frame: usize) -> HumanJoints {
        self.clip.pose(frame).forward_kinematics(self.body)
    }

    /// Mean speed of the hips along their path, m/s.
    pub(crate) fn mean_speed_mps(&self) -> f64 {
        let path_m: f64 = self.hips_m.windows(2).map(|pair| pair[1].distance(pair[0])).sum();
        path_m * self.frame_rate_hz / (self.hips_m.len().max(2) - 1) as f64
    }

    /// Mean speed of all joints along their paths, m/s.
    pub(crate) fn mean_joint_speed_mps(&self) -> f64 {
        let path_m = self.joint_path_m.last().copied().unwrap_or_default();
        path_m * self.frame_rate_hz / (self.joint_path_m.len().max(2) - 1) as f64
    }

    /// Speed of the hips in a straight line from the first frame to the last, m/s.
    pub(crate) fn net_speed_mps(&self) -> f64 {
        let (first, last) = (self.hips_m[0], self.hips_m[self.hips_m.len() - 1]);
        first.distance(last) * self.frame_rate_hz / self.hips_m.len() as f64
    }

    /// Greatest horizontal distance of an ankle, within some frames, from its position in the first, m.
    pub(crate) fn ankles_travel_m(&self, frames: Range<usize>) -> f64 {
        let first_m = self.ankles_m[frames.start];
        let travel_m =
            |side: usize| frames.clone().map(move |frame| self.ankles_m[frame][side].distance(first_m[side]));
        travel_m(0).chain(travel_m(1)).fold(0.0, f64::max)
    }

    /// Hips and facing at a fractional frame, linearly between frames, with the time that the caller gives them.
    pub(crate) fn root_at(&self, frame: f64, time_s: f64) -> RootSample {
        let base = (frame.max(0.0) as usize).min(self.hips_m.len() - 2);
        let share = frame - base as f64;
        let facing_rad = self.facing_rad[base] + share * (self.facing_rad[base + 1] - self.facing_rad[base]);
        RootSample { time_s, hips_m: self.hips_m[base].lerp(self.hips_m[base + 1], share), facing_rad }
    }
}

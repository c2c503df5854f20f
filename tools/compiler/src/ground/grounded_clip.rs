//! A clip on a target body: its poses, stored once.
//!
//! Poses that differ from those of the imported clip by their position alone are not stored again, nor are the rounds of
//! a loop: an hour of capture takes a tenth of a gigabyte. World frame: metres, radians, Z up.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::ground::grounded_poses::GroundedPoses;
use crate::ground::loop_rounds::LoopRounds;
use crate::ground::pose_mean::pose_between;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// A clip on a target body. Where it has poses of its own, the rotations of successive poses lie in one hemisphere.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GroundedClip<'a> {
    /// Frames per second.
    pub frame_rate_hz: f64,
    /// One pose a frame in the world; of a loop those of one round.
    pub(crate) poses: GroundedPoses<'a>,
    /// The three rounds of a clip that is a loop.
    pub(crate) rounds: Option<LoopRounds>,
}

impl GroundedClip<'_> {
    /// Number of frames; of a loop those of three rounds and the frame after them.
    pub fn frame_count(&self) -> usize {
        self.rounds.as_ref().map_or(self.poses.len(), LoopRounds::frame_count)
    }

    /// Frames of one round of a clip that is a loop. Frames `loop_frames..2·loop_frames` are the middle round.
    pub fn loop_frames(&self) -> Option<usize> {
        self.rounds.as_ref().map(|rounds| rounds.round)
    }

    /// Frees the poses outside some ranges of frames, in any order; none of them may be read afterwards. A loop keeps its
    /// round where a range holds any frame.
    pub(crate) fn keep_frames(&mut self, mut ranges: Vec<Range<usize>>) {
        let count = self.poses.len();
        if self.rounds.is_some() && !ranges.is_empty() {
            ranges.clear();
            ranges.push(0..count);
        }
        ranges.sort_by_key(|range| range.start);
        let mut disjoint: Vec<Range<usize>> = Vec::new();
        for range in ranges.into_iter().map(|range| range.start.min(count)..range.end.min(count)) {
            match disjoint.last_mut() {
                Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
                _ => disjoint.push(range),
            }
        }
        disjoint.retain(|range| !range.is_empty());
        self.poses.keep(&disjoint);
    }

    /// The pose of a frame in the world.
    pub fn pose(&self, frame: usize) -> HumanPose {
        self.rounds.as_ref().map_or_else(|| self.poses.pose(frame), |rounds| rounds.pose(&self.poses, frame))
    }

    /// The pose at a fractional frame, clamped to the clip.
    pub fn pose_at(&self, frame: f64, body: &HumanBody) -> HumanPose {
        let last = self.frame_count() - 1;
        let base = (frame.max(0.0) as usize).min(last.saturating_sub(1));
        let neighbours = [base.saturating_sub(1), base, (base + 1).min(last), (base + 2).min(last)];
        pose_between(neighbours.map(|frame| self.pose(frame)), (frame - base as f64).clamp(0.0, 1.0), body)
    }
}

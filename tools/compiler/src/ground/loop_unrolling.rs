//! Loops: a clip whose last pose is its first is repeated three times, so that every stride has neighbours and counts.
//!
//! The gap between the last pose and the first is spread evenly over the round, so that the seam is like any other
//! frame. World frame: metres, radians, Z up; times in frames of the clip.

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use motiondb::statistics::median;

use crate::ground::root_motion::GroundedClip;
use crate::ground::rotations::{align_successive, ground_rotation, rotation_vector};
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Greatest distance of any joint between last pose and first, relative to the root, of a loop, m.
const LOOP_GAP_M: f64 = 0.04;
/// The same as a share of the clip's usual step from pose to pose: short loops whose keys do not fall on frames.
const LOOP_GAP_STEPS: f64 = 0.5;
/// A loop leaves out its repeated frame where the pose that would follow is nearer to the first by this ratio.
const LEFT_OUT_RATIO: f64 = 0.5;
/// Copies of a loop: one before and one after the copy that is analysed.
const ROUNDS: usize = 3;
/// Least duration of a loop, s; shorter clips are poses.
const ROUND_MIN_S: f64 = 0.3;

/// Three rounds of a clip that is a loop; any other clip unchanged.
pub(crate) fn unrolled(clip: GroundedClip, body: &HumanBody) -> GroundedClip {
    match round_frames(&clip, body) {
        Some(round) => repeated(clip, body, round),
        None => clip,
    }
}

/// Frames of one round of a clip that is a loop. Some loops end one frame before they would repeat their first pose.
fn round_frames(clip: &GroundedClip, body: &HumanBody) -> Option<usize> {
    let [first, .., before, last] = clip.poses.as_slice() else { return None };
    let next_gap_m = loop_gap_m(first, &next_pose(before, last), body);
    let last_gap_m = loop_gap_m(first, last, body);
    let is_left_out = next_gap_m < LEFT_OUT_RATIO * last_gap_m;
    let round = clip.poses.len() - usize::from(!is_left_out);
    let usual_step_m = median(clip.poses.windows(2).map(|pair| loop_gap_m(&pair[0], &pair[1], body)))?;
    let gap_max_m = LOOP_GAP_M.max(LOOP_GAP_STEPS * usual_step_m);
    let is_loop = last_gap_m.min(next_gap_m) <= gap_max_m && round as f64 >= ROUND_MIN_S * clip.frame_rate_hz;
    is_loop.then_some(round)
}

/// Three rounds of a clip that is known to be a loop of `round` frames. Where the clip has no more frames than that,
/// the pose that would follow closes it.
pub(crate) fn repeated(mut clip: GroundedClip, body: &HumanBody, round: usize) -> GroundedClip {
    if let ([.., before, last], true) = (clip.poses.as_slice(), round == clip.poses.len()) {
        clip.poses.push(next_pose(before, last));
    }
    let seam = LoopSeam::between(&clip.poses[0], &clip.poses[round], body);
    let closed: Vec<HumanPose> =
        (0..round).map(|frame| seam.close(&clip.poses[frame], frame as f64 / round as f64)).collect();
    let mut poses = Vec::with_capacity(ROUNDS * round + 1);
    for copy in 0..ROUNDS {
        poses.extend(closed.iter().map(|pose| seam.carry(pose, copy)));
    }
    poses.push(seam.carry(&closed[0], ROUNDS));
    align_successive(&mut poses);
    GroundedClip { poses, loop_frames: Some(round), ..clip }
}

/// The pose after two successive ones at constant velocity.
fn next_pose(before: &HumanPose, last: &HumanPose) -> HumanPose {
    let rotations =
        std::array::from_fn(|joint| last.rotations[joint] * before.rotations[joint].inverse() * last.rotations[joint]);
    HumanPose { pelvis_m: 2.0 * last.pelvis_m - before.pelvis_m, rotations }
}

/// The greatest distance between a joint's positions in two poses, each relative to hips and facing, m.
fn loop_gap_m(first: &HumanPose, last: &HumanPose, body: &HumanBody) -> f64 {
    let local = |pose: &HumanPose| {
        let joints = pose.forward_kinematics(body);
        let turn = DQuat::from_rotation_z(-joints.facing_rad());
        let ground = joints.hips_m().with_z(0.0);
        joints.positions_m.map(|position| turn * (position - ground))
    };
    local(first).iter().zip(&local(last)).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// Displacement of the body by one round of a loop, and the gap that the round leaves.
struct LoopSeam {
    /// Pelvis of the first pose on the ground, m.
    start_m: DVec3,
    /// Displacement of the pelvis on the ground by one round, m.
    travelled_m: DVec3,
    /// Change of the facing by one round, rad.
    turned_rad: f64,
    /// Height of the first pelvis above the last, m.
    height_gap_m: f64,
    /// Rotations from the last pose's joints back to the first's, as rotation vectors, rad.
    rotation_gaps: [DVec3; JOINT_COUNT],
}

impl LoopSeam {
    fn between(first: &HumanPose, last: &HumanPose, body: &HumanBody) -> Self {
        let (from, to) = (first.forward_kinematics(body), last.forward_kinematics(body));
        let turned_rad = to.facing_rad() - from.facing_rad();
        let turn = DQuat::from_rotation_z(turned_rad);
        let rotation_gaps = std::array::from_fn(|joint| {
            let closing = if joint == 0 { turn * first.rotations[0] } else { first.rotations[joint] };
            rotation_vector(closing * last.rotations[joint].inverse())
        });
        let travelled_m = (last.pelvis_m - first.pelvis_m).with_z(0.0);
        let height_gap_m = first.pelvis_m.z - last.pelvis_m.z;
        Self { start_m: first.pelvis_m.with_z(0.0), travelled_m, turned_rad, height_gap_m, rotation_gaps }
    }

    /// A pose of the round with its part of the gap added: none at the first pose, all at the last.
    fn close(&self, pose: &HumanPose, share: f64) -> HumanPose {
        let mut closed = pose.clone();
        closed.pelvis_m.z += self.height_gap_m * share;
        for (rotation, gap) in closed.rotations.iter_mut().zip(&self.rotation_gaps) {
            *rotation = DQuat::from_scaled_axis(*gap * share) * *rotation;
        }
        closed
    }

    /// A pose some rounds later.
    fn carry(&self, pose: &HumanPose, rounds: usize) -> HumanPose {
        let mut carried = pose.clone();
        for _ in 0..rounds {
            let from_start_m = ground_rotation(self.turned_rad) * (carried.pelvis_m - self.start_m).truncate();
            carried.pelvis_m = self.start_m + self.travelled_m + from_start_m.extend(carried.pelvis_m.z);
            carried.rotations[0] = DQuat::from_rotation_z(self.turned_rad) * carried.rotations[0];
        }
        carried
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::root_arc::Rates;
    use crate::ground::root_motion::grounded_clip;
    use crate::synthetic::{self, SyntheticWalk};

    /// A walk of exactly `strides` strides.
    fn whole(strides: f64) -> SyntheticWalk {
        let rates = Rates { speed_mps: 0.7, turn_rate_rad_s: 0.8, strafe_mps: 0.0 };
        SyntheticWalk { rates, period_s: 1.1, duration_s: 1.1 * strides, ..SyntheticWalk::default() }
    }

    #[test]
    fn rounds_join_without_a_jump() {
        let clip = synthetic::walk("loop", whole(1.0));
        let clip_in_rounds = unrolled(grounded_clip(&clip, &clip.body), &clip.body);
        let positions_m: Vec<_> =
            clip_in_rounds.poses.iter().map(|p| p.forward_kinematics(&clip.body).positions_m).collect();
        let step = |frame: usize| {
            let pairs = positions_m[frame].iter().zip(&positions_m[frame + 1]);
            pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
        };
        let largest = (0..65).map(step).fold(0.0, f64::max);
        assert!(step(65) <= largest && step(131) <= largest, "{} {} {largest}", step(65), step(131));
    }

    #[test]
    fn loops_may_leave_out_their_repeated_frame() {
        let mut clip = synthetic::walk("loop", whole(2.0));
        clip.frames.pop();
        assert_eq!(unrolled(grounded_clip(&clip, &clip.body), &clip.body).loop_frames, Some(132));
    }

    #[test]
    fn short_loops_may_end_between_frames() {
        let rates = Rates { speed_mps: 2.8, ..Rates::default() };
        let run = SyntheticWalk {
            rates,
            period_s: 0.555,
            duration_s: 0.555,
            frame_rate_hz: 24.0,
            ..SyntheticWalk::default()
        };
        let clip = synthetic::walk("loop", run);
        let grounded = grounded_clip(&clip, &clip.body);
        assert!(loop_gap_m(&grounded.poses[0], &grounded.poses[13], &clip.body) > LOOP_GAP_M);
        assert_eq!(unrolled(grounded, &clip.body).loop_frames, Some(13));
    }

    #[test]
    fn clips_that_end_in_another_pose_are_no_loops() {
        let clip = synthetic::walk("part", whole(1.4));
        assert_eq!(unrolled(grounded_clip(&clip, &clip.body), &clip.body).loop_frames, None);
    }
}

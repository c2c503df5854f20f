//! Loops: a clip whose last pose is its first is repeated three times, so that every stride has neighbours and counts.
//!
//! The gap between the last pose and the first is spread evenly over the round, so that the seam is like any other
//! frame. One round is stored; the poses of the others are computed from it, so that a loop of an hour takes no more
//! memory than another clip. World frame: metres, radians, Z up; times in frames of the clip.

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use motiondb::statistics::median;

use crate::ground::grounded_clip::GroundedClip;
use crate::ground::grounded_poses::GroundedPoses;
use crate::ground::loop_rounds::{LoopRounds, LoopSeam};
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Greatest distance of any joint between last pose and first, relative to the root, of a loop, m.
const LOOP_GAP_M: f64 = 0.04;
/// The same as a share of the clip's usual step from pose to pose: short loops whose keys do not fall on frames.
const LOOP_GAP_STEPS: f64 = 0.5;
/// A loop leaves out its repeated frame where the pose that would follow is nearer to the first by this ratio.
const LEFT_OUT_RATIO: f64 = 0.5;
/// Least duration of a loop, s; shorter clips are poses.
const ROUND_MIN_S: f64 = 0.3;

/// Three rounds of a clip that is a loop; any other clip unchanged.
pub(crate) fn unrolled<'a>(clip: GroundedClip<'a>, body: &HumanBody) -> GroundedClip<'a> {
    match round_frames(&clip, body) {
        Some(round) => repeated(clip, body, round),
        None => clip,
    }
}

/// Frames of one round of a clip that is a loop. Some loops end one frame before they would repeat their first pose.
fn round_frames(clip: &GroundedClip, body: &HumanBody) -> Option<usize> {
    let count = clip.poses.len();
    let [before, last] = [count.checked_sub(2).filter(|&before| before > 0)?, count - 1];
    let local_m = |pose: &HumanPose| local_positions_m(pose, body);
    let [first_m, last_m] = [0, last].map(|frame| local_m(&clip.poses.pose(frame)));
    let next_m = local_m(&next_pose(&clip.poses.pose(before), &clip.poses.pose(last)));
    let [next_gap_m, last_gap_m] = [next_m, last_m].map(|end_m| loop_gap_m(&first_m, &end_m));
    let is_left_out = next_gap_m < LEFT_OUT_RATIO * last_gap_m;
    let round = count - usize::from(!is_left_out);
    let mut before_m = first_m;
    let step_m = |frame: usize| {
        let at_m = local_m(&clip.poses.pose(frame));
        loop_gap_m(&std::mem::replace(&mut before_m, at_m), &at_m)
    };
    let usual_step_m = median((1..count).map(step_m))?;
    let gap_max_m = LOOP_GAP_M.max(LOOP_GAP_STEPS * usual_step_m);
    let is_loop = last_gap_m.min(next_gap_m) <= gap_max_m && round as f64 >= ROUND_MIN_S * clip.frame_rate_hz;
    is_loop.then_some(round)
}

/// Three rounds of a clip that is known to be a loop of `round` frames. Where the clip has no more frames than that,
/// the pose that would follow closes it.
pub(crate) fn repeated<'a>(mut clip: GroundedClip<'a>, body: &HumanBody, round: usize) -> GroundedClip<'a> {
    let pose = |frame: usize| clip.poses.pose(frame);
    let end = if round < clip.poses.len() { pose(round) } else { next_pose(&pose(round - 2), &pose(round - 1)) };
    let seam = LoopSeam::between(&pose(0), &end, body);
    let mut rounds = LoopRounds { round, seam, flipped: Vec::new() };
    if let GroundedPoses::Own(poses) = &mut clip.poses {
        poses.truncate(round);
        poses.iter_mut().enumerate().for_each(|(frame, pose)| rounds.close(pose, frame));
        rounds.align_successive(&clip.poses);
    }
    GroundedClip { rounds: Some(rounds), ..clip }
}

/// The pose after two successive ones at constant velocity.
fn next_pose(before: &HumanPose, last: &HumanPose) -> HumanPose {
    let next = |(before, last): (&DQuat, &DQuat)| *last * before.inverse() * *last;
    let rotations = std::array::from_fn(|joint| next((&before.rotations[joint], &last.rotations[joint])));
    let extra = before.extra.iter().zip(&last.extra).map(next).collect();
    HumanPose { pelvis_m: 2.0 * last.pelvis_m - before.pelvis_m, rotations, extra }
}

/// Positions of the joints relative to hips and facing, m.
fn local_positions_m(pose: &HumanPose, body: &HumanBody) -> [DVec3; JOINT_COUNT] {
    let joints = pose.forward_kinematics(body);
    let turn = DQuat::from_rotation_z(-joints.facing_rad());
    let ground = joints.hips_m().with_z(0.0);
    joints.positions_m.map(|position| turn * (position - ground))
}

/// The greatest distance between a joint's positions in two poses, each relative to hips and facing, m.
fn loop_gap_m(first: &[DVec3; JOINT_COUNT], last: &[DVec3; JOINT_COUNT]) -> f64 {
    first.iter().zip(last).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
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
        let positions_m: Vec<_> = (0..clip_in_rounds.frame_count())
            .map(|frame| clip_in_rounds.pose(frame).forward_kinematics(&clip.body).positions_m)
            .collect();
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
        assert_eq!(unrolled(grounded_clip(&clip, &clip.body), &clip.body).loop_frames(), Some(132));
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
        let [first_m, last_m] = [0, 13].map(|frame| local_positions_m(&grounded.pose(frame), &clip.body));
        assert!(loop_gap_m(&first_m, &last_m) > LOOP_GAP_M);
        assert_eq!(unrolled(grounded, &clip.body).loop_frames(), Some(13));
    }

    #[test]
    fn clips_that_end_in_another_pose_are_no_loops() {
        let clip = synthetic::walk("part", whole(1.4));
        assert_eq!(unrolled(grounded_clip(&clip, &clip.body), &clip.body).loop_frames(), None);
    }
}

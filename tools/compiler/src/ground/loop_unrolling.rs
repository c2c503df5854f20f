//! Loops: a clip whose last pose is its first goes round three times, so that every stride of it has neighbours and all
//! strides count.
//!
//! What is left between the last pose and the first is spread evenly over the round, so that the seam is like any other
//! frame.

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use motiondb::statistics::median;

use crate::ground::arc::rotation;
use crate::ground::root_motion::{GroundedClip, align_hemispheres};
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Every joint of the last pose this near to the first's, relative to the root: a loop.
const LOOP_GAP_M: f64 = 0.04;
/// So is a clip whose last pose is nearer to its first than this share of what its own poses usually lie apart: short
/// loops of few frames a second, whose keys do not fall on frames.
const LOOP_GAP_STEPS: f64 = 0.5;
/// The repeated frame is left out where the pose that would follow is this much nearer to the first than the last one
/// is.
const LEFT_OUT_RATIO: f64 = 0.5;
/// Copies of a loop: one before and one after the one that is analysed.
const ROUNDS: usize = 3;
/// Shorter clips are poses, not loops.
const ROUND_MIN_S: f64 = 0.3;

/// The clip three times round where it is a loop, else unchanged.
pub(crate) fn unroll(clip: GroundedClip, body: &HumanBody) -> GroundedClip {
    match round_frames(&clip, body) {
        Some(round) => repeat(clip, body, round),
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

/// The clip, known to be a loop of so many frames, three times round. The frame after its last may close it.
pub(crate) fn repeat(mut clip: GroundedClip, body: &HumanBody, round: usize) -> GroundedClip {
    if let ([.., before, last], true) = (clip.poses.as_slice(), round == clip.poses.len()) {
        clip.poses.push(next_pose(before, last));
    }
    let seam = Seam::between(&clip.poses[0], &clip.poses[round], body);
    let closed: Vec<HumanPose> =
        (0..round).map(|frame| seam.close(&clip.poses[frame], frame as f64 / round as f64)).collect();
    let mut poses = Vec::with_capacity(ROUNDS * round + 1);
    for copy in 0..ROUNDS {
        poses.extend(closed.iter().map(|pose| seam.carry(pose, copy)));
    }
    poses.push(seam.carry(&closed[0], ROUNDS));
    align_hemispheres(&mut poses);
    GroundedClip { poses, loop_frames: Some(round), ..clip }
}

/// The pose that would follow if all went on as it did.
fn next_pose(before: &HumanPose, last: &HumanPose) -> HumanPose {
    let rotations =
        std::array::from_fn(|joint| last.rotations[joint] * before.rotations[joint].inverse() * last.rotations[joint]);
    HumanPose { pelvis_m: 2.0 * last.pelvis_m - before.pelvis_m, rotations }
}

/// The greatest distance between a joint's places in two poses, each relative to its root.
fn loop_gap_m(first: &HumanPose, last: &HumanPose, body: &HumanBody) -> f64 {
    let local = |pose: &HumanPose| {
        let joints = pose.forward_kinematics(body);
        let turn = DQuat::from_rotation_z(-joints.facing_rad());
        let ground = joints.hips_m().with_z(0.0);
        joints.positions_m.map(|position| turn * (position - ground))
    };
    local(first).iter().zip(&local(last)).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// How one round of a loop moves the body, and what it leaves open.
struct Seam {
    start_m: DVec3,
    travelled_m: DVec3,
    turned_rad: f64,
    height_gap_m: f64,
    /// From the last pose's rotations back to the first's, as rotation vectors.
    rotation_gaps: [DVec3; JOINT_COUNT],
}

impl Seam {
    fn between(first: &HumanPose, last: &HumanPose, body: &HumanBody) -> Self {
        let (from, to) = (first.forward_kinematics(body), last.forward_kinematics(body));
        let turned_rad = to.facing_rad() - from.facing_rad();
        let turn = DQuat::from_rotation_z(turned_rad);
        let rotation_gaps = std::array::from_fn(|joint| {
            let wanted = if joint == 0 { turn * first.rotations[0] } else { first.rotations[joint] };
            let gap = wanted * last.rotations[joint].inverse();
            (if gap.w < 0.0 { -gap } else { gap }).to_scaled_axis()
        });
        let travelled_m = (last.pelvis_m - first.pelvis_m).with_z(0.0);
        let height_gap_m = first.pelvis_m.z - last.pelvis_m.z;
        Self { start_m: first.pelvis_m.with_z(0.0), travelled_m, turned_rad, height_gap_m, rotation_gaps }
    }

    /// A pose of the round with its part of the gap added: none at the first, all at the last.
    fn close(&self, pose: &HumanPose, share: f64) -> HumanPose {
        let mut closed = pose.clone();
        closed.pelvis_m.z += self.height_gap_m * share;
        for (rotation, gap) in closed.rotations.iter_mut().zip(&self.rotation_gaps) {
            *rotation = DQuat::from_scaled_axis(*gap * share) * *rotation;
        }
        closed
    }

    /// A pose as it is some rounds later.
    fn carry(&self, pose: &HumanPose, rounds: usize) -> HumanPose {
        let mut carried = pose.clone();
        for _ in 0..rounds {
            let off = rotation(self.turned_rad) * (carried.pelvis_m - self.start_m).truncate();
            carried.pelvis_m = self.start_m + self.travelled_m + off.extend(carried.pelvis_m.z);
            carried.rotations[0] = DQuat::from_rotation_z(self.turned_rad) * carried.rotations[0];
        }
        carried
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait::windows::{self, Gait, Window};
    use crate::ground::arc::Rates;
    use crate::ground::root_motion::ground;
    use crate::synthetic::{self, Walk};

    /// A walk of exactly `strides` strides.
    fn whole(strides: f64) -> Walk {
        let rates = Rates { speed_mps: 0.7, turn_rate_rad_s: 0.8, strafe_mps: 0.0 };
        Walk { rates, period_s: 1.1, duration_s: 1.1 * strides, ..Walk::default() }
    }

    #[test]
    fn all_strides_of_a_loop_count() {
        let clip = synthetic::walk("loop", whole(2.0));
        let unrolled = unroll(ground(&clip, &clip.body), &clip.body);
        assert_eq!(unrolled.loop_frames, Some(132));
        let windows = windows::analyze(&unrolled, &clip.body).windows.unwrap();
        let [Window { gait: Gait::Steps(strides), .. }] = &windows[..] else { panic!("{windows:?}") };
        assert_eq!(strides.len(), 2);
        for stride in strides {
            assert!((stride.arc.rates.speed_mps - 0.7).abs() < 0.01, "{stride:?}");
            assert!((stride.arc.rates.turn_rate_rad_s - 0.8).abs() < 0.01, "{stride:?}");
        }
    }

    #[test]
    fn rounds_follow_each_other_without_a_jump() {
        let clip = synthetic::walk("loop", whole(1.0));
        let unrolled = unroll(ground(&clip, &clip.body), &clip.body);
        let places: Vec<_> = unrolled.poses.iter().map(|p| p.forward_kinematics(&clip.body).positions_m).collect();
        let step = |frame: usize| {
            places[frame].iter().zip(&places[frame + 1]).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
        };
        let largest = (0..65).map(step).fold(0.0, f64::max);
        assert!(step(65) <= largest && step(131) <= largest, "{} {} {largest}", step(65), step(131));
    }

    #[test]
    fn a_loop_may_leave_out_its_repeated_frame() {
        let mut clip = synthetic::walk("loop", whole(2.0));
        clip.frames.pop();
        assert_eq!(unroll(ground(&clip, &clip.body), &clip.body).loop_frames, Some(132));
    }

    #[test]
    fn a_loop_of_few_frames_may_end_a_part_of_a_frame_before_its_first_pose() {
        let rates = Rates { speed_mps: 2.8, ..Rates::default() };
        let run = Walk { rates, period_s: 0.555, duration_s: 0.555, frame_rate_hz: 24.0, ..Walk::default() };
        let clip = synthetic::walk("loop", run);
        let grounded = ground(&clip, &clip.body);
        assert!(loop_gap_m(&grounded.poses[0], &grounded.poses[13], &clip.body) > LOOP_GAP_M);
        assert_eq!(unroll(grounded, &clip.body).loop_frames, Some(13));
    }

    #[test]
    fn a_clip_that_ends_in_another_pose_is_no_loop() {
        let clip = synthetic::walk("part", whole(1.4));
        assert_eq!(unroll(ground(&clip, &clip.body), &clip.body).loop_frames, None);
    }
}

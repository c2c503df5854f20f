//! A rest → a loop of poses: the longest part whose ends are alike, faded into itself.
//!
//! 1. The cut: of all pairs of times the one whose poses are most alike, where a shorter loop costs something
//!    ([`SHORTNESS_COST`]). A clip that is a loop is cut at its own seam.
//! 2. The fade: towards its end the loop changes evenly into the frames before its beginning, so that neither pose nor
//!    velocity jumps at the seam.
//!
//! World frame: metres, seconds; times in frames of the clip.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::JOINT_COUNT;
use motiondb::statistics::mean;

use crate::action::cut_action::sample_frames;
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::pose_mean::pose_mean;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Greatest duration of an idle, s.
const LOOP_MAX_S: f64 = 20.0;
/// Longest part of a rest in which a loop is searched, s.
const SEARCHED_MAX_S: f64 = 120.0;
/// Greatest duration of the fade at the end of a loop, s.
const FADE_MAX_S: f64 = 0.8;
/// Greatest share of a rest that the fade takes.
const FADE_MAX_SHARE: f64 = 0.2;
/// Step between the times that are tried as ends of a loop, s.
const CUT_STEP_S: f64 = 0.1;
/// Cost of a loop without length, over that of ends as unlike as two poses of the rest usually are: of two loops the
/// longer one may close less well.
const SHORTNESS_COST: f64 = 2.0;
/// Least length of a loop over the greatest.
const LENGTH_MIN_SHARE: f64 = 0.3;
/// Weight of a joint's velocity beside its position where poses are compared, s.
const VELOCITY_WEIGHT_S: f64 = 0.1;

/// A loop cut out of a rest.
pub(crate) struct IdleLoop {
    /// First and last frame of the clip; the pose of the last is faded into that of the first.
    pub(crate) frames: [f64; 2],
    /// Poses at the rate of actions; the last is the first.
    pub(crate) poses: Vec<HumanPose>,
}

/// The loop of a rest.
pub(crate) fn idle_loop(clip: &GroundedClip, body: &HumanBody, rest: &Range<usize>) -> IdleLoop {
    let rest_frames = (rest.len() - 1) as f64;
    let fade = (FADE_MAX_S * clip.frame_rate_hz).min(FADE_MAX_SHARE * rest_frames);
    let ends = match clip.loop_frames().filter(|round| rest.len() > *round) {
        Some(round) => [rest.start as f64, (rest.start + round) as f64],
        None => best_cut(clip, body, rest, fade),
    };
    let [first, last] = ends;
    let pose = |frame: f64| {
        let share = (frame - (last - fade)) / fade;
        let here = clip.pose_at(frame, body);
        if share <= 0.0 {
            return here;
        }
        let share = share * share * (3.0 - 2.0 * share);
        pose_mean(&[(1.0 - share, here), (share, clip.pose_at(frame - (last - first), body))], body)
    };
    let mut poses: Vec<HumanPose> = sample_frames(ends, clip.frame_rate_hz).map(pose).collect();
    let end = poses.len() - 1;
    poses[end] = poses[0].clone();
    IdleLoop { frames: ends, poses }
}

/// First and last frame of the best loop in a rest, `fade` frames after its beginning.
fn best_cut(clip: &GroundedClip, body: &HumanBody, rest: &Range<usize>, fade: f64) -> [f64; 2] {
    let step = (CUT_STEP_S * clip.frame_rate_hz).max(1.0);
    let last = ((rest.len() - 1) as f64).min(SEARCHED_MAX_S * clip.frame_rate_hz);
    let times: Vec<f64> = (0..).map(|index| fade + step * f64::from(index)).take_while(|time| *time <= last).collect();
    let features: Vec<[DVec3; 2 * JOINT_COUNT]> =
        times.iter().map(|time| features_m(clip, body, rest.start as f64 + time)).collect();
    let longest = (last - fade).min(LOOP_MAX_S * clip.frame_rate_hz);
    let cuts = (0..times.len()).flat_map(|first| (first + 1..times.len()).map(move |end| [first, end]));
    let length = |[first, end]: [usize; 2]| times[end] - times[first];
    let cuts: Vec<[usize; 2]> =
        cuts.filter(|&cut| length(cut) <= longest && length(cut) >= LENGTH_MIN_SHARE * longest).collect();
    let gap_m = |[first, end]: [usize; 2]| distance_m(&features[first], &features[end]);
    let usual_m = mean(cuts.iter().map(|&cut| gap_m(cut))).unwrap_or_default().max(f64::MIN_POSITIVE);
    let cost = |cut: [usize; 2]| gap_m(cut) / usual_m + SHORTNESS_COST * (1.0 - length(cut) / longest);
    let best = cuts.into_iter().min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
    best.map_or([fade, last], |cut| cut.map(|index| times[index])).map(|time| rest.start as f64 + time)
}

/// Positions and weighted velocities of all joints at a frame, m.
fn features_m(clip: &GroundedClip, body: &HumanBody, frame: f64) -> [DVec3; 2 * JOINT_COUNT] {
    let positions_m = |frame: f64| clip.pose_at(frame, body).forward_kinematics(body).positions_m;
    let [before, here, after] = [frame - 1.0, frame, frame + 1.0].map(positions_m);
    std::array::from_fn(|index| match index.checked_sub(JOINT_COUNT) {
        None => here[index],
        Some(joint) => (after[joint] - before[joint]) * (0.5 * clip.frame_rate_hz * VELOCITY_WEIGHT_S),
    })
}

/// Mean distance of the joints, by position and by weighted velocity, m.
fn distance_m(one: &[DVec3; 2 * JOINT_COUNT], other: &[DVec3; 2 * JOINT_COUNT]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a.distance(*b)).sum::<f64>() / JOINT_COUNT as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::root_motion::grounded_clip;
    use crate::synthetic;
    use motiondb::body::Joint;

    /// Speeds of the spine from pose to pose, radians a sample, and at the seam.
    #[test]
    fn neither_pose_nor_velocity_jumps_at_the_seam() {
        let clip = synthetic::idle("idle", 9.3);
        let grounded = grounded_clip(&clip, &clip.body);
        let IdleLoop { frames, poses } = idle_loop(&grounded, &clip.body, &(0..clip.frames.len()));
        let duration_s = (frames[1] - frames[0]) / 60.0;
        assert!((5.0..9.3).contains(&duration_s), "{duration_s} s of 9.3");
        let spine = Joint::SpineUpper.index();
        let step = |from: usize, to: usize| poses[from].rotations[spine].angle_between(poses[to].rotations[spine]);
        let last = poses.len() - 1;
        assert_eq!(poses[0], poses[last]);
        let largest = (0..last).map(|pose| step(pose, pose + 1)).fold(0.0, f64::max);
        let own = 0.02 / 31.0;
        assert!(largest < 1.6 * own, "{largest} rad, {own} in the clip");
        let change = (step(last - 1, last) - step(0, 1)).abs();
        assert!(change < 0.3 * own, "the speed changes by {change} rad a frame");
    }
}

//! A separate first pose: many files begin with a T-pose and jump from it into the motion, or blend out of it over some
//! frames (PFNN: 40).
//!
//! A jump is cut off. A blend stays, since it is a motion, but is told: an example is made from a steady window and
//! leaves it out.

use glam::DVec3;
use motiondb::skeleton::Joint;

use crate::skeleton_map::Roles;
use crate::source_clip::SourceClip;
use crate::units::middle;

/// The first step is a jump where it is this many times the median step and 5 cm more.
const JUMP_TIMES_MEDIAN: f64 = 8.0;
const JUMP_MIN_M: f64 = 0.05;
/// Shorter clips have no median to speak of.
const FRAMES_MIN: usize = 11;
/// Arms are spread in a T-pose when both lie this near the shoulder line (cosine of 30°), and no longer when one is
/// past 45°.
const SPREAD_COSINE: f64 = 0.87;
const LOWERED_COSINE: f64 = 0.71;

/// Drops a first frame from which the pose jumps; the clip is in metres, Z up.
pub(crate) fn drop_separate_first_pose(clip: &mut SourceClip, roles: &Roles) {
    if clip.frame_count() < FRAMES_MIN {
        return;
    }
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let mut steps: Vec<f64> = (1..clip.frame_count()).map(|frame| pose_step(clip, roles, &joints, frame)).collect();
    let first = steps.remove(0);
    steps.sort_by(f64::total_cmp);
    if first > JUMP_TIMES_MEDIAN * steps[steps.len() / 2] + JUMP_MIN_M {
        clip.keep_frames(1..clip.frame_count());
        clip.warnings.push("the first frame is a separate pose and is not used".to_owned());
    }
    if spread(clip, roles, 0) > SPREAD_COSINE {
        let lowered = (1..clip.frame_count()).find(|&frame| spread(clip, roles, frame) < LOWERED_COSINE);
        clip.warnings.extend(lowered.map(|frames| format!("the first {frames} frames come out of a T-pose")));
    }
}

/// Cosine between the shoulder line and the arm that is farther from it.
fn spread(clip: &SourceClip, roles: &Roles, frame: usize) -> f64 {
    let at = |joint: Joint| clip.position(frame, roles.required(joint));
    let across = (at(Joint::LeftUpperArm) - at(Joint::RightUpperArm)).normalize_or_zero();
    let left = (at(Joint::LeftHand) - at(Joint::LeftUpperArm)).normalize_or_zero();
    let right = (at(Joint::RightHand) - at(Joint::RightUpperArm)).normalize_or_zero();
    left.dot(across).min(-right.dot(across))
}

/// How far the joint that moves most against the hips moves between two frames, m.
fn pose_step(clip: &SourceClip, roles: &Roles, joints: &[usize], frame: usize) -> f64 {
    let relative = |frame: usize, joint: usize| -> DVec3 {
        clip.position(frame, joint) - middle(clip, roles, Joint::THIGHS, frame)
    };
    joints.iter().map(|&joint| (relative(frame, joint) - relative(frame - 1, joint)).length()).fold(0.0, f64::max)
}

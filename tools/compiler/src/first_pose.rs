//! A separate first pose: many files begin with a T-pose and jump from it into the motion.

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
        clip.drop_first_frames(1);
        clip.warnings.push("the first frame is a separate pose and is not used".to_owned());
    }
}

/// How far the joint that moves most against the hips moves between two frames, m.
fn pose_step(clip: &SourceClip, roles: &Roles, joints: &[usize], frame: usize) -> f64 {
    let relative = |frame: usize, joint: usize| -> DVec3 {
        clip.position(frame, joint) - middle(clip, roles, Joint::THIGHS, frame)
    };
    joints.iter().map(|&joint| (relative(frame, joint) - relative(frame - 1, joint)).length()).fold(0.0, f64::max)
}

//! Poses that are not part of the motion: a separate first pose, and T-poses and frozen poses at the ends of a clip.
//!
//! Many files begin with a T-pose. Some jump from it into the motion, some stand in it for seconds while a suit is
//! calibrated, some blend out of it (PFNN: over 40 frames); some end in one. Where a scene is longer than its action,
//! exports repeat a pose, often in mid-stride, which would be an idle. All of these frames are removed.
//! Whole-clip parameters are measured after the first removal and before the second: one separate frame spoils them,
//! while a blend or a calibration is part of the clip. Clips are in metres, z up.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Warning};

use crate::gait::standing::{STANDING_JOINT_SPEED_MPS, STANDING_MIN_S};
use crate::read::source_clip::SourceClip;
use crate::retarget::units::middle;
use crate::rig::roles::Roles;

/// Least size of a jump from a separate first pose, divided by the median step between two frames.
const JUMP_OVER_MEDIAN: f64 = 8.0;
/// Size of a jump beyond [`JUMP_OVER_MEDIAN`] times the median step, m.
const JUMP_MIN_M: f64 = 0.05;
/// Least size of a jump, divided by the step after it: a pose that blends into the motion moves on.
const JUMP_OVER_NEXT: f64 = 3.0;
/// Least number of frames of a clip whose poses are removed: shorter clips have no meaningful median.
const FRAMES_MIN: usize = 11;
/// Least cosine between arms and shoulder line in a T-pose (30°).
pub(crate) const SPREAD_COSINE: f64 = 0.87;
/// Cosine between an arm and the shoulder line below which the pose is not a T-pose (45°).
const LOWERED_COSINE: f64 = 0.71;
/// Least duration of the moving frames that remain, s: a stride.
const REST_MIN_S: f64 = 1.0;
/// Duration for which a pose at an end of a clip may be frozen, s: a hand-keyed stop, too short for an idle.
const HELD_MAX_S: f64 = 0.5;
/// Greatest displacement of a joint between two frames that are the same, m: some rounding errors.
const SAME_POSE_M: f64 = 1e-6;

/// Removes a first frame from which the pose jumps into the motion.
pub(crate) fn drop_separate_first_pose(clip: &mut SourceClip, roles: &Roles) {
    if clip.frame_count() < FRAMES_MIN {
        return;
    }
    let joints = role_joints(roles);
    let mut steps_m: Vec<f64> = (1..clip.frame_count()).map(|frame| pose_step_m(clip, roles, &joints, frame)).collect();
    let first_m = steps_m.remove(0);
    let next_m = steps_m[0];
    let jumps = first_m > (JUMP_OVER_MEDIAN * upper_median(steps_m) + JUMP_MIN_M).max(JUMP_OVER_NEXT * next_m);
    let drops_arms = spread_cosine(clip, roles, 0) > SPREAD_COSINE && spread_cosine(clip, roles, 1) < LOWERED_COSINE;
    if jumps || drops_arms {
        clip.keep_frames(1..clip.frame_count());
        clip.diagnostics.push(Diagnostic::Note(Note::FirstPoseCut));
    }
}

/// Removes the T-poses in which a clip begins and ends, and the motion between them and the rest. They stay, with a
/// warning, where too little would be left.
pub(crate) fn drop_t_poses(clip: &mut SourceClip, roles: &Roles) {
    let count = clip.frame_count();
    let spreads: Vec<f64> = (0..count).map(|frame| spread_cosine(clip, roles, frame)).collect();
    let first = t_pose_frames(spreads.iter().copied());
    let last = t_pose_frames(spreads.iter().rev().copied());
    let (Some(first), Some(last)) = (first, last) else { return };
    let kept: Range<usize> = first..count.saturating_sub(last).max(first);
    let is_enough = kept.len() >= FRAMES_MIN && kept.len() as f64 >= least_s(clip, roles, &kept) * clip.frame_rate_hz;
    for (frames, end) in [(first as u32, ClipEnd::First), (last as u32, ClipEnd::Last)] {
        let found = match is_enough {
            true => Diagnostic::Note(Note::TPoseCut { frames, end }),
            false => Diagnostic::Warning(Warning::TPoseKept { frames, end }),
        };
        clip.diagnostics.extend((frames > 0).then_some(found));
    }
    if is_enough {
        clip.keep_frames(kept);
    }
}

/// Removes the frames at both ends in which nothing moves, but for half a second. They stay where the body moves for
/// less than a stride; a clip in which nothing moves gets a warning.
pub(crate) fn drop_held_ends(clip: &mut SourceClip, roles: &Roles) {
    let (count, joints) = (clip.frame_count(), role_joints(roles));
    let step_m = |frame: usize, joint: usize| clip.position(frame, joint).distance(clip.position(frame - 1, joint));
    let moves = |frame: &usize| joints.iter().any(|&joint| step_m(*frame, joint) > SAME_POSE_M);
    let (Some(first), Some(last)) = ((1..count).find(moves), (1..count).rev().find(moves)) else {
        clip.diagnostics.push(Diagnostic::Warning(Warning::PoseFrozen));
        return;
    };
    if ((last + 1 - first) as f64) < REST_MIN_S * clip.frame_rate_hz {
        return;
    }
    let held = (HELD_MAX_S * clip.frame_rate_hz) as usize;
    let kept = (first - 1).saturating_sub(held)..(last + 1 + held).min(count);
    for (frames, end) in [(kept.start, ClipEnd::First), (count - kept.end, ClipEnd::Last)] {
        let cut = Diagnostic::Note(Note::HeldPoseCut { frames: frames as u32, end });
        clip.diagnostics.extend((frames > 0).then_some(cut));
    }
    clip.keep_frames(kept);
}

/// Least duration of these frames alone, s: a stride, or for a body that stands the least duration of an idle.
fn least_s(clip: &SourceClip, roles: &Roles, kept: &Range<usize>) -> f64 {
    let joints = role_joints(roles);
    let step = |frame: usize, joint: usize| clip.position(frame, joint).distance(clip.position(frame - 1, joint));
    let path_m: f64 = kept.clone().skip(1).flat_map(|frame| joints.iter().map(move |&joint| step(frame, joint))).sum();
    let mean_mps = path_m * clip.frame_rate_hz / (joints.len() * kept.len()).max(1) as f64;
    if mean_mps < STANDING_JOINT_SPEED_MPS { STANDING_MIN_S } else { REST_MIN_S }
}

/// Number of frames from a T-pose until the arms are as low as usual: 0 if the first frame is not a T-pose, none if all
/// frames are.
fn t_pose_frames(mut spreads: impl Iterator<Item = f64> + Clone) -> Option<usize> {
    if spreads.clone().next().is_none_or(|spread| spread <= SPREAD_COSINE) {
        return Some(0);
    }
    let lowered = spreads.clone().position(|spread| spread < LOWERED_COSINE)?;
    let usual = upper_median(spreads.clone().skip(lowered).collect());
    spreads.position(|spread| spread < LOWERED_COSINE && spread <= usual)
}

fn spread_cosine(clip: &SourceClip, roles: &Roles, frame: usize) -> f64 {
    arm_spread(|joint| clip.position(frame, roles.required(joint)))
}

/// Cosine between the shoulder line and the arm that is farther off it: 1 in a T-pose.
pub(crate) fn arm_spread(position: impl Fn(Joint) -> DVec3) -> f64 {
    let across = (position(Joint::LeftUpperArm) - position(Joint::RightUpperArm)).normalize_or_zero();
    let left = (position(Joint::LeftHand) - position(Joint::LeftUpperArm)).normalize_or_zero();
    let right = (position(Joint::RightHand) - position(Joint::RightUpperArm)).normalize_or_zero();
    left.dot(across).min(-right.dot(across))
}

/// Greatest displacement of a joint against the hips since the frame before, m.
fn pose_step_m(clip: &SourceClip, roles: &Roles, joints: &[usize], frame: usize) -> f64 {
    let relative = |frame: usize, joint: usize| -> DVec3 {
        clip.position(frame, joint) - middle(clip, roles, Joint::THIGHS, frame)
    };
    joints.iter().map(|&joint| (relative(frame, joint) - relative(frame - 1, joint)).length()).fold(0.0, f64::max)
}

/// Source joints of all roles.
fn role_joints(roles: &Roles) -> Vec<usize> {
    roles.joints.iter().flatten().copied().collect()
}

/// The greater of the two middle values.
fn upper_median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

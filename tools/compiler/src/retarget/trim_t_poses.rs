//! Poses that are no part of the motion: many files begin with a T-pose and jump from it into the motion, stand in it
//! for seconds while a suit is calibrated, or blend out of it over some frames (PFNN: 40); some end in one.
//!
//! All are cut off. Whole-clip parameters are measured between the two cuts: a single foreign frame spoils them, a
//! blend or a calibration is a part of the clip. The clip is in metres, Z up.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Warning};

use crate::gait::standing::{STANDING_JOINT_SPEED_MPS, STANDING_MIN_S};
use crate::read::source_clip::SourceClip;
use crate::retarget::units::middle;
use crate::rig::roles::Roles;

/// The first step is a jump where it is this many times the median step and 5 cm more.
const JUMP_TIMES_MEDIAN: f64 = 8.0;
const JUMP_MIN_M: f64 = 0.05;
/// Shorter clips have no median to speak of.
const FRAMES_MIN: usize = 11;
/// Arms are spread in a T-pose when both lie this near the shoulder line (cosine of 30°), and no longer when one is
/// past 45°.
const SPREAD_COSINE: f64 = 0.87;
const LOWERED_COSINE: f64 = 0.71;
/// What is left without the T-poses must hold a stride, s, or, of a body that stands, as much as makes an idle; else
/// they stay.
const LEFT_MIN_S: f64 = 1.0;

/// Drops a first frame from which the pose jumps.
pub(crate) fn drop_separate_first_pose(clip: &mut SourceClip, roles: &Roles) {
    if clip.frame_count() < FRAMES_MIN {
        return;
    }
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let mut steps: Vec<f64> = (1..clip.frame_count()).map(|frame| pose_step(clip, roles, &joints, frame)).collect();
    let first = steps.remove(0);
    steps.sort_by(f64::total_cmp);
    let jumps = first > JUMP_TIMES_MEDIAN * steps[steps.len() / 2] + JUMP_MIN_M;
    let drops_arms = spread(clip, roles, 0) > SPREAD_COSINE && spread(clip, roles, 1) < LOWERED_COSINE;
    if jumps || drops_arms {
        clip.keep_frames(1..clip.frame_count());
        clip.diagnostics.push(Diagnostic::Note(Note::FirstPoseCut));
    }
}

/// Drops the T-poses in which a clip begins and ends, with the way out of the one and into the other.
pub(crate) fn drop_t_poses(clip: &mut SourceClip, roles: &Roles) {
    let count = clip.frame_count();
    let spreads: Vec<f64> = (0..count).map(|frame| spread(clip, roles, frame)).collect();
    let first = t_pose_frames(spreads.iter().copied());
    let last = t_pose_frames(spreads.iter().rev().copied());
    let (Some(first), Some(last)) = (first, last) else { return };
    let kept: Range<usize> = first..count.saturating_sub(last).max(first);
    let fits = kept.len() >= FRAMES_MIN && kept.len() as f64 >= left_min_s(clip, roles, &kept) * clip.frame_rate_hz;
    for (frames, end) in [(first as u32, ClipEnd::First), (last as u32, ClipEnd::Last)] {
        let found = match fits {
            true => Diagnostic::Note(Note::TPoseCut { frames, end }),
            false => Diagnostic::Warning(Warning::TPoseKept { frames, end }),
        };
        clip.diagnostics.extend((frames > 0).then_some(found));
    }
    if fits {
        clip.keep_frames(kept);
    }
}

fn left_min_s(clip: &SourceClip, roles: &Roles, kept: &Range<usize>) -> f64 {
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let step = |frame: usize, joint: usize| clip.position(frame, joint).distance(clip.position(frame - 1, joint));
    let way_m: f64 = kept.clone().skip(1).flat_map(|frame| joints.iter().map(move |&joint| step(frame, joint))).sum();
    let stir_mps = way_m * clip.frame_rate_hz / (joints.len() * kept.len()).max(1) as f64;
    if stir_mps < STANDING_JOINT_SPEED_MPS { STANDING_MIN_S } else { LEFT_MIN_S }
}

/// How many frames it takes from a T-pose until the arms are where they usually are; none in one all along.
fn t_pose_frames(mut spreads: impl Iterator<Item = f64> + Clone) -> Option<usize> {
    if spreads.clone().next().is_none_or(|spread| spread <= SPREAD_COSINE) {
        return Some(0);
    }
    let lowered = spreads.clone().position(|spread| spread < LOWERED_COSINE)?;
    let mut usual: Vec<f64> = spreads.clone().skip(lowered).collect();
    usual.sort_by(f64::total_cmp);
    let median = usual[usual.len() / 2];
    spreads.position(|spread| spread < LOWERED_COSINE && spread <= median)
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

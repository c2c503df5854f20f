//! Where the pose of a clip jumps: two takes joined without a blend, a lost marker, a character that is put elsewhere.
//!
//! In a thirtieth of a second a joint moves much farther than in that before and in that after: limbs that are thrown
//! that fast move on. Displacements against the hips, of the hips in the world. Clips are in metres, z up.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::Warning;

use crate::frame_runs::frame_runs;
use crate::read::source_clip::SourceClip;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Span in which a pose jumps, s.
const SPAN_S: f64 = 1.0 / 30.0;
/// Least displacement in a jump, m for a person's leg, beside that of the motion.
const JUMP_MIN_M: f64 = 0.08;
/// Least displacement in a jump, multiple of that in the spans before and after.
const JUMP_OVER_BESIDE: f64 = 3.0;

/// A jump of the pose.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PoseJump {
    /// The frames before, in and after the jump.
    pub(crate) frames: Range<usize>,
    /// Greatest displacement of a joint, m.
    pub(crate) distance_m: f64,
}

/// The jumps of a clip, in order of time.
pub(crate) fn pose_jumps(clip: &SourceClip, roles: &Roles) -> Vec<PoseJump> {
    let count = clip.frame_count();
    let span = (libm::round(SPAN_S * clip.frame_rate_hz) as usize).max(1);
    if count < 3 * span + 1 {
        return Vec::new();
    }
    let least_m = JUMP_MIN_M * leg_length(clip, roles) / HUMAN_LEG_M;
    let hips: Vec<DVec3> = (0..count).map(|frame| middle(clip, roles, Joint::THIGHS, frame)).collect();
    let mut jumps_m = vec![0.0_f64; count - span];
    let mut mark = |position: &dyn Fn(usize) -> DVec3| {
        let steps_m: Vec<f64> = (span..count).map(|frame| position(frame).distance(position(frame - span))).collect();
        for first in span..steps_m.len() - span {
            let beside_m = steps_m[first - span].max(steps_m[first + span]);
            if steps_m[first] > least_m + JUMP_OVER_BESIDE * beside_m {
                jumps_m[first] = jumps_m[first].max(steps_m[first]);
            }
        }
    };
    mark(&|frame| hips[frame]);
    for &joint in roles.joints.iter().flatten() {
        mark(&|frame| clip.position(frame, joint) - hips[frame]);
    }
    let jump = |spans: Range<usize>| PoseJump {
        distance_m: jumps_m[spans.clone()].iter().copied().fold(0.0, f64::max),
        frames: spans.start..spans.end + span,
    };
    frame_runs(&jumps_m.iter().map(|jump_m| *jump_m > 0.0).collect::<Vec<bool>>(), true).into_iter().map(jump).collect()
}

/// The warning that names the greatest jump.
pub(crate) fn warning(clip: &SourceClip, jumps: &[PoseJump]) -> Option<Warning> {
    let greatest = jumps.iter().rev().max_by(|a, b| a.distance_m.total_cmp(&b.distance_m))?;
    let frame = (clip.first_frame + greatest.frames.start) as f64 + 0.5 * (greatest.frames.len() - 1) as f64;
    Some(Warning::PoseJumps {
        at_s: (frame / clip.frame_rate_hz) as f32,
        distance_cm: (100.0 * greatest.distance_m) as f32,
        more: jumps.len() as u32 - 1,
    })
}

//! Figures of a rest: what a body that stands does with its arms, and how calm it is.
//!
//! Arms that hang, are folded or rest on the hips make an idle. Arms spread out make a bind pose, raised ones an aimed
//! gun: no crowd stands so. World frame: metres, seconds; angles in degrees.

use std::ops::Range;

use motiondb::diagnostic::Unfit;
use motiondb::statistics::mean;

use crate::checks::spread_arms::{ARMS_OUT_DEG, ARMS_UP_DEG};
use crate::gait::body_track::chord_frames;
use crate::ground::grounded_clip::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::retarget::trim_t_poses::{SPREAD_COSINE, arm_spread};
use crate::rig::body_angles::{arms_deg, arms_out_deg, trunk_lean_deg};
use crate::rig::roles::ARMS;

/// Number of frames, spread over a rest, in which it is measured.
const SAMPLES: usize = 32;
/// Angle from straight down above which the higher arm counts as raised, degrees: folded arms have up to 67, an aimed
/// gun 90.
const ARM_RAISED_DEG: f64 = 75.0;

/// Figures of a rest, means over its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rest {
    /// Duration, s.
    pub(crate) duration_s: f64,
    /// Height of the wrists over the shoulders, arm lengths, plus 1: 0 for arms that hang, 1 for level ones.
    pub(crate) arms_raised: f64,
    /// Cosine between the shoulder line and the arm that is farther off it: 1 in a T-pose.
    pub(crate) arms_spread: f64,
    /// Angle off straight down of straight arms that point aside, the lesser of both; 0 for other arms.
    pub(crate) arms_out_deg: f64,
    /// Angle off straight down of the higher wrist, seen from its shoulder.
    pub(crate) higher_arm_deg: f64,
    /// Lean of the trunk off the vertical, degrees.
    pub(crate) lean_deg: f64,
    /// Height of the hips over the ankles, leg lengths.
    pub(crate) hips_legs: f64,
    /// Speed of the joints, m/s.
    pub(crate) joint_speed_mps: f64,
}

impl Rest {
    /// The figures of some frames of a clip.
    pub(crate) fn of(clip: &GroundedClip, frames: &Range<usize>, body: &HumanBody) -> Self {
        let step = frames.len().div_ceil(SAMPLES);
        let joints_at = |frame: usize| clip.pose(frame).forward_kinematics(body);
        let joints: Vec<HumanJoints> = frames.clone().step_by(step).map(joints_at).collect();
        let mean_of = |value: &dyn Fn(&HumanJoints) -> f64| mean(joints.iter().map(value)).unwrap_or_default();
        let chord = chord_frames(clip.frame_rate_hz).min(frames.len() - 1);
        let chord_m = |frame: usize| joints_at(frame).mean_distance_m(&joints_at(frame + chord));
        let chords_m = (frames.start..frames.end - chord).step_by(step).map(chord_m);
        Self {
            duration_s: (frames.len() - 1) as f64 / clip.frame_rate_hz,
            arms_raised: mean_of(&arms_raised),
            arms_spread: mean_of(&|joints| arm_spread(|joint| joints.position_m(joint))),
            arms_out_deg: mean_of(&|joints| arms_out_deg(|joint| joints.position_m(joint))),
            higher_arm_deg: mean_of(&|joints| {
                arms_deg(|joint| joints.position_m(joint)).into_iter().fold(0.0, f64::max)
            }),
            lean_deg: mean_of(&|joints| trunk_lean_deg(|joint| joints.position_m(joint))),
            hips_legs: mean_of(&hips_over_ankles_m) / body.leg_length_m(),
            joint_speed_mps: mean(chords_m).unwrap_or_default() * clip.frame_rate_hz / chord.max(1) as f64,
        }
    }

    /// Why no crowd stands so; `None` for a body that stands at ease.
    pub(crate) fn unfit(&self) -> Option<Unfit> {
        match self {
            rest if rest.arms_spread > SPREAD_COSINE => Some(Unfit::TPose),
            rest if rest.arms_out_deg > ARMS_UP_DEG => Some(Unfit::ArmRaised),
            rest if rest.arms_out_deg > ARMS_OUT_DEG => Some(Unfit::ArmsOut),
            rest if rest.higher_arm_deg > ARM_RAISED_DEG => Some(Unfit::ArmRaised),
            _ => None,
        }
    }
}

/// Mean height of the hips over the ankles, m.
fn hips_over_ankles_m(joints: &HumanJoints) -> f64 {
    let [left_m, right_m] = joints.hip_heights_m();
    0.5 * (left_m + right_m)
}

/// Height of the wrists over the shoulders, arm lengths, plus 1; mean of both arms.
fn arms_raised(joints: &HumanJoints) -> f64 {
    let [left, right] =
        ARMS.map(|[shoulder, _, wrist]| (joints.position_m(wrist) - joints.position_m(shoulder)).normalize_or_zero().z);
    1.0 + 0.5 * (left + right)
}

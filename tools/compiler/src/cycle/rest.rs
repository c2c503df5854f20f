//! Figures of a rest: what a body that stands does with its arms, and how calm it is.
//!
//! Arms that hang make an idle; arms spread out make a bind pose, which no crowd stands in. World frame: metres,
//! seconds.

use std::ops::Range;

use motiondb::body::Joint;
use motiondb::statistics::mean;

use crate::ground::grounded_clip::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::retarget::trim_t_poses::{SPREAD_COSINE, arm_spread};

/// Number of frames, spread over a rest, in which it is measured.
const SAMPLES: usize = 32;

/// Figures of a rest, means over its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rest {
    /// Duration, s.
    pub(crate) duration_s: f64,
    /// Height of the wrists over the shoulders, arm lengths, plus 1: 0 for arms that hang, 1 for level ones.
    pub(crate) arms_raised: f64,
    /// Cosine between the shoulder line and the arm that is farther off it: 1 in a T-pose.
    pub(crate) arms_spread: f64,
}

impl Rest {
    /// The figures of some frames of a clip.
    pub(crate) fn of(clip: &GroundedClip, frames: &Range<usize>, body: &HumanBody) -> Self {
        let step = frames.len().div_ceil(SAMPLES);
        let joints: Vec<HumanJoints> =
            frames.clone().step_by(step).map(|frame| clip.pose(frame).forward_kinematics(body)).collect();
        let spread = |joints: &HumanJoints| arm_spread(|joint| joints.positions_m[joint.index()]);
        Self {
            duration_s: (frames.len() - 1) as f64 / clip.frame_rate_hz,
            arms_raised: mean(joints.iter().map(arms_raised)).unwrap_or_default(),
            arms_spread: mean(joints.iter().map(spread)).unwrap_or_default(),
        }
    }

    /// Whether the body stands in a T-pose.
    pub(crate) fn is_t_pose(&self) -> bool {
        self.arms_spread > SPREAD_COSINE
    }
}

/// Height of the wrists over the shoulders, arm lengths, plus 1; mean of both arms.
fn arms_raised(joints: &HumanJoints) -> f64 {
    let height = |[shoulder, wrist]: [Joint; 2]| {
        let [shoulder_m, wrist_m] = [shoulder, wrist].map(|joint| joints.positions_m[joint.index()]);
        (wrist_m - shoulder_m).normalize_or_zero().z
    };
    let [left, right] = [[Joint::LeftUpperArm, Joint::LeftHand], [Joint::RightUpperArm, Joint::RightHand]].map(height);
    1.0 + 0.5 * (left + right)
}

//! Figures of a rest: what a body that stands does with its arms, and how calm it is.
//!
//! Arms that hang make an idle; arms spread out make a bind pose, which no crowd stands in. World frame: metres,
//! seconds.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::statistics::mean;

use crate::ground::grounded_clip::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::retarget::trim_t_poses::SPREAD_COSINE;

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
        let joints = || {
            let step = frames.len().div_ceil(SAMPLES);
            frames.clone().step_by(step).map(|frame| clip.pose(frame).forward_kinematics(body))
        };
        Self {
            duration_s: (frames.len() - 1) as f64 / clip.frame_rate_hz,
            arms_raised: 1.0
                + mean(joints().map(|joints| arms(&joints).map(|arm| arm.z).iter().sum::<f64>() / 2.0)).unwrap_or(0.0),
            arms_spread: mean(joints().map(|joints| spread(&joints))).unwrap_or(0.0),
        }
    }

    /// Whether the body stands in a T-pose.
    pub(crate) fn is_t_pose(&self) -> bool {
        self.arms_spread > SPREAD_COSINE
    }
}

/// Unit vectors from the shoulders to the wrists, `[left, right]`.
fn arms(joints: &HumanJoints) -> [DVec3; 2] {
    let at = |joint: Joint| joints.positions_m[joint.index()];
    [[Joint::LeftUpperArm, Joint::LeftHand], [Joint::RightUpperArm, Joint::RightHand]]
        .map(|[shoulder, wrist]| (at(wrist) - at(shoulder)).normalize_or_zero())
}

fn spread(joints: &HumanJoints) -> f64 {
    let [left, right] = Joint::UPPER_ARMS.map(|joint| joints.positions_m[joint.index()]);
    let across = (left - right).normalize_or_zero();
    let [left, right] = arms(joints).map(|arm| arm.dot(across));
    left.min(-right)
}

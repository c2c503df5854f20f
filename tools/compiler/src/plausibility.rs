//! Whether a gait can be true: the ratio of step length to cadence, which people keep at 0.6–0.7 cm/(step/min) over all speeds, slow or
//! running (`facts/motion.md` §4). A lying `Frame Time:` scales it by the square of the lie: the CMU run 02_03 at 1/25 s instead of
//! 1/120 s comes out at 11.

use motiondb::skeleton::Joint;

use crate::skeleton_map::Roles;
use crate::source_clip::SourceClip;
use crate::source_parameters::{WholeClip, facing_rad};
use crate::units::{HUMAN_LEG_M, leg_length};

/// Plausible walk ratios, cm/(step/min), for a person's leg. Clips of the development set: 0.27 (careful small steps) to 1.1 (sprint).
const WALK_RATIO_CM_MIN: std::ops::RangeInclusive<f64> = 0.15..=2.0;
/// Slower clips stand, turn or side-step, m/s.
const SPEED_MIN_MPS: f64 = 0.4;
/// Fewer steps say nothing.
const STEPS_MIN: usize = 3;

/// The warning, where steps and speed do not go together.
pub(crate) fn implausible_gait(clip: &SourceClip, roles: &Roles, whole: &WholeClip) -> Option<String> {
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let speed_mps = whole.speed_mps.abs() / scale;
    let passings = passings(clip, roles);
    let [first, .., last] = passings[..] else { return None };
    let steps = passings.len() - 1;
    if speed_mps < SPEED_MIN_MPS || steps < STEPS_MIN {
        return None;
    }
    let steps_per_s = steps as f64 * clip.frame_rate_hz / (last - first) as f64;
    let step_cm = 100.0 * speed_mps / steps_per_s;
    let walk_ratio = step_cm / (60.0 * steps_per_s);
    (!WALK_RATIO_CM_MIN.contains(&walk_ratio)).then(|| {
        format!(
            "steps of {step_cm:.0} cm, {:.0} a minute, are no human gait: is the frame time true?",
            60.0 * steps_per_s
        )
    })
}

/// The frames in which one foot passes the other along the facing: once a step.
fn passings(clip: &SourceClip, roles: &Roles) -> Vec<usize> {
    let lead = |frame: usize| {
        let [left, right] = Joint::FEET.map(|foot| clip.position(frame, roles.required(foot)));
        let facing = facing_rad(clip, roles, frame);
        (left - right).x * libm::cos(facing) + (left - right).y * libm::sin(facing)
    };
    let leads: Vec<f64> = (0..clip.frame_count()).map(lead).collect();
    (1..leads.len()).filter(|&frame| (leads[frame - 1] < 0.0) != (leads[frame] < 0.0)).collect()
}

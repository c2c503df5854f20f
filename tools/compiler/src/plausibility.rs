//! Whether a gait and a body can be true.
//!
//! Of a gait: the ratio of step length to cadence, which people keep at 0.6–0.7 cm/(step/min) over all speeds, slow or
//! running (`facts/motion.md` §4). A lying `Frame Time:` scales it by the square of the lie: the CMU run 02_03 at 1/25
//! s instead of 1/120 s comes out at 11.

use motiondb::skeleton::Joint;

use crate::error::Refusal;
use crate::human_clip::HumanBody;
use crate::root_motion::leg_length_m;
use crate::skeleton_map::Roles;
use crate::source_clip::SourceClip;
use crate::source_parameters::{WholeClip, facing_rad};
use crate::units::{HUMAN_LEG_M, leg_length};

/// Plausible walk ratios, cm/(step/min), for a person's leg. Clips of the development set: 0.27 (careful small steps)
/// to 1.1 (sprint).
const WALK_RATIO_CM_MIN: std::ops::RangeInclusive<f64> = 0.15..=2.0;
/// Slower clips stand, turn or side-step, m/s.
const SPEED_MIN_MPS: f64 = 0.4;
/// Fewer steps say nothing.
const STEPS_MIN: usize = 3;

/// Thigh plus shank of all that walks, from a toy to a giant, m; a database takes no others.
const LEG_M: std::ops::RangeInclusive<f64> = 0.1..=2.9;
/// Least share of the leg that each of its two bones has: no knee bends with less. People: 0.47 to 0.53.
const LEG_BONE_SHARE_MIN: f64 = 0.15;
/// Longest other bone, or foot, over the leg. People: 0.5 (upper trunk); drawn characters with large heads: 1.
const BONE_OVER_LEG_MAX: f64 = 1.5;

/// The refusal, where bones are none of a body that could walk.
pub(crate) fn impossible_body(body: &HumanBody) -> Option<Refusal> {
    let leg_m = leg_length_m(body);
    let leg_bones = [Joint::SHANKS, Joint::FEET].concat();
    let shortest_m = leg_bones.iter().map(|joint| body.offsets_m[joint.index()].length()).fold(f64::INFINITY, f64::min);
    let bones = body.offsets_m.iter().chain(&body.segment_ends_m).chain(body.soles_m.iter().flatten());
    let longest_m = bones.map(|bone| bone.length()).fold(0.0, f64::max);
    let reason = if !LEG_M.contains(&leg_m) {
        format!("thigh and shank are {leg_m:.3} m long")
    } else if shortest_m < LEG_BONE_SHARE_MIN * leg_m {
        format!("of legs of {leg_m:.3} m one bone has {shortest_m:.3} m")
    } else if longest_m > BONE_OVER_LEG_MAX * leg_m {
        format!("on legs of {leg_m:.3} m it has a bone of {longest_m:.3} m")
    } else {
        return None;
    };
    Some(Refusal::Disproportionate { reason })
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic;

    fn check_refused(change: impl Fn(&mut HumanBody), word: &str) {
        let mut body = synthetic::body(1.0);
        assert_eq!(impossible_body(&body), None);
        change(&mut body);
        let refusal = impossible_body(&body).map(|refusal| refusal.to_string()).unwrap_or_default();
        assert!(refusal.contains(word), "{refusal}");
    }

    #[test]
    fn bodies_that_could_not_walk_are_refused() {
        check_refused(|body| body.offsets_m.iter_mut().for_each(|offset| *offset *= 1e-6), "thigh and shank");
        check_refused(|body| body.offsets_m.iter_mut().for_each(|offset| *offset *= 7.0), "thigh and shank");
        check_refused(|body| body.offsets_m[Joint::LeftFoot.index()] *= 0.01, "one bone has");
        check_refused(|body| body.segment_ends_m[Joint::Head.index()].z = 1e6, "a bone of");
        check_refused(|body| body.soles_m[0][2].x = f64::INFINITY, "a bone of");
    }
}

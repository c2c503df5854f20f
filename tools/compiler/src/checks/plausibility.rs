//! Whether unit, up axis, gait and body of a clip can be true. Source clips in metres, z up, unless stated otherwise.
//!
//! A gait is judged by its cadence and by its walk ratio, step length divided by cadence, which people keep at 0.6 to
//! 0.7 cm/(step/min) over most speeds (Sekiya and Nagasaki 1998). A wrong frame time scales both. Steps of legs of
//! another length scale with that length, cadences with the inverse of its root. A body is judged by its size and its
//! bones.

use std::ops::RangeInclusive;

use glam::DVec2;
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Unfit, Warning};
use motiondb::statistics::median;

use crate::error::RejectionReason;
use crate::read::source_clip::SourceClip;
use crate::retarget::foot_passings::{LEAD_MIN_M, foot_passings};
use crate::retarget::human_clip::HumanBody;
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, found_up, leg_length, middle};
use crate::rig::roles::Roles;

/// Plausible walk ratios, cm/(step/min), for a person's leg. Development set: 0.27 (small steps) to 1.1 (sprint).
const WALK_RATIO_CM_MIN: RangeInclusive<f64> = 0.15..=2.0;
/// Walk ratio above which a walk looks like slow motion, cm/(step/min), for a person's leg: half the frame rate doubles
/// the ratio. Development set: 0.93 and less.
const SLOW_MOTION_CM_MIN: f64 = 1.05;
/// The same of a gait whose feet stand as briefly as in a run. Brisk walks: 0.76 and less; jogs at half their speed
/// from 0.9 on.
const SLOW_RUN_CM_MIN: f64 = 0.85;
/// Cadence below which such a gait is slow motion, steps/min, for a person's leg. Development set: dashes from 126 on;
/// brisk walks and runs at half their speed up to 84.
const SLOW_RUN_PER_MIN: f64 = 105.0;
/// Turn per step above which short steps are no sign of a wrong frame time, rad: 30°.
const TURN_OF_STEP_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Walk ratio below which a gait of a high cadence looks like quick motion, cm/(step/min), for a person's leg: twice the
/// frame rate halves the ratio. Walks at twice their speed: 0.27 to 0.42.
const QUICK_MOTION_CM_MIN: f64 = 0.42;
/// Cadences above which a gait of such a ratio is quick motion, `[walk, other gait]`, steps/min, for a person's leg.
/// Greatest in the development set: 158 and 175.
const QUICK_PER_MIN: [f64; 2] = [165.0, 190.0];
/// Greatest cadence, steps/min, for a person's leg (sprinters: 290).
const CADENCE_MAX_PER_MIN: f64 = 320.0;
/// Greatest cadence of a walk, steps/min, for a person's leg (race walkers over 20 km: 186 to 210).
const WALK_CADENCE_MAX_PER_MIN: f64 = 215.0;
/// Share of the time above which the ball of a foot stands as in a walk: 0.48 of the cycle in walks (Perry), 0.4 in
/// jogs.
const WALK_PLANTED_SHARE: f64 = 0.45;
/// Leg length, divided by a person's, above which quick motion is not judged: animated giants may have a human cadence.
const GIANT_SCALE: f64 = 1.5;
/// Least length of steps that are judged, m for a person's leg.
const STEP_MIN_M: f64 = 0.2;
/// Least number of steps that are judged.
const STEPS_MIN: usize = 3;

/// Accepted thigh plus shank, m, from a toy to a giant: those of a database.
const LEG_M: RangeInclusive<f64> = 0.1..=2.9;
/// Least share of a leg that each of its two bones has, for a knee that bends. People: 0.47 to 0.53.
const LEG_BONE_SHARE_MIN: f64 = 0.15;
/// Greatest length of another bone, or of a foot, divided by the leg's. People: 0.5; drawn characters with large heads:
/// 1.
const BONE_OVER_LEG_MAX: f64 = 1.5;
/// Thigh plus shank of people, m, from the age of four on (about 0.4) to the tallest.
const HUMAN_LEG_RANGE_M: RangeInclusive<f64> = 0.38..=1.2;

/// The warning that no human has legs of this length. If the unit is wrong, so are all speeds.
pub(crate) fn size_warning(clip: &SourceClip, roles: &Roles) -> Option<Warning> {
    let leg_m = leg_length(clip, roles);
    (!HUMAN_LEG_RANGE_M.contains(&leg_m)).then_some(Warning::InhumanSize { leg_m: leg_m as f32 })
}

/// Removes the unit that the format states, with a warning, where no body of that size walks. Enters a clip in source
/// units.
pub(crate) fn drop_implausible_unit(clip: &mut SourceClip, roles: &Roles) {
    let Some(metres_per_unit) = clip.metres_per_unit else { return };
    let leg_m = metres_per_unit * leg_length(clip, roles);
    if !LEG_M.contains(&leg_m) {
        clip.metres_per_unit = None;
        clip.diagnostics.push(Diagnostic::Warning(Warning::UnitRejected { leg_m: leg_m as f32 }));
    }
}

/// The verdict that the body does not stand along the up axis that a manifest states. Enters a clip in source axes.
pub(crate) fn contradicted_up(clip: &SourceClip, roles: &Roles) -> Option<Unfit> {
    let (stated, found) = (clip.up_axis?, found_up(clip, roles));
    (stated != found).then(|| Unfit::UpContradicted { stated: stated.name(), found: found.name() })
}

/// The reason why no body with these bones walks.
pub(crate) fn impossible_body(body: &HumanBody) -> Option<RejectionReason> {
    let leg_m = body.leg_length_m();
    let leg_bones = [Joint::SHANKS, Joint::FEET].concat();
    let shortest_m = leg_bones.iter().map(|joint| body.offsets_m[joint.index()].length()).fold(f64::INFINITY, f64::min);
    let bones = body.offsets_m.iter().chain(&body.segment_ends_m).chain(body.soles_m.iter().flatten());
    let longest_m = bones.map(|bone| bone.length()).fold(0.0, f64::max);
    if !LEG_M.contains(&leg_m) {
        Some(RejectionReason::LegLength { leg_m })
    } else if shortest_m < LEG_BONE_SHARE_MIN * leg_m {
        Some(RejectionReason::ShortLegBone { leg_m, bone_m: shortest_m })
    } else if longest_m > BONE_OVER_LEG_MAX * leg_m {
        Some(RejectionReason::LongBone { leg_m, bone_m: longest_m })
    } else {
        None
    }
}

/// The verdict that no human steps so, because the frame time is wrong, and with it all speeds; or the warning that it
/// may be.
pub(crate) fn doubtful_gait(clip: &SourceClip, roles: &Roles, parameters: &SourceParameters) -> Option<Diagnostic> {
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let passings = foot_passings(clip, roles, LEAD_MIN_M * scale);
    let steps: Vec<(usize, usize)> = passings.windows(2).map(|pair| (pair[0], pair[1])).collect();
    if steps.len() < STEPS_MIN {
        return None;
    }
    // By strides: frames are too coarse for single steps, and limbs may be unequal.
    let step_s = median(passings.windows(3).map(|stride| (stride[2] - stride[0]) as f64))? / (2.0 * clip.frame_rate_hz);
    let hips = |frame: usize| middle(clip, roles, Joint::THIGHS, frame).truncate();
    let step_m = match parameters.is_in_place {
        true => parameters.speed_mps.abs() * step_s,
        false => median(steps.iter().map(|&(from, to)| (hips(to) - hips(from)).length()))?,
    };
    let (human_step_cm, human_cadence) = (100.0 * step_m / scale, 60.0 / step_s * scale.sqrt());
    let (walks, walk_ratio) = (walks(clip, roles, parameters), human_step_cm / human_cadence);
    let cadence_max = if walks { WALK_CADENCE_MAX_PER_MIN } else { CADENCE_MAX_PER_MIN };
    let [step_cm, steps_per_min] = [100.0 * step_m, 60.0 / step_s].map(|figure| figure as f32);
    // Steps of a tight turn are short.
    let turns = parameters.turn_rate_rad_s.abs() * step_s > TURN_OF_STEP_RAD;
    let least_ratio = if turns { 0.0 } else { *WALK_RATIO_CM_MIN.start() };
    if human_step_cm < 100.0 * STEP_MIN_M {
        None
    } else if human_cadence >= cadence_max || walk_ratio < least_ratio || walk_ratio > *WALK_RATIO_CM_MIN.end() {
        Some(Diagnostic::NoExample(Unfit::InhumanGait { step_cm, steps_per_min }))
    } else {
        let frame_rate_hz = clip.frame_rate_hz as f32;
        let quick_per_min = QUICK_PER_MIN[usize::from(!walks)];
        let is_slow = match walks {
            true => walk_ratio > SLOW_MOTION_CM_MIN,
            false => walk_ratio > SLOW_RUN_CM_MIN && human_cadence < SLOW_RUN_PER_MIN,
        };
        let is_short = walk_ratio < QUICK_MOTION_CM_MIN && !turns;
        let is_quick = is_short && human_cadence > quick_per_min && scale < GIANT_SCALE;
        let slow = is_slow.then_some(Warning::FrameTimeDoubtful { step_cm, steps_per_min, frame_rate_hz });
        let quick = is_quick.then_some(Warning::QuickMotion { step_cm, steps_per_min, frame_rate_hz });
        slow.or(quick).map(Diagnostic::Warning)
    }
}

/// Whether feet stand as long as in a walk.
fn walks(clip: &SourceClip, roles: &Roles, parameters: &SourceParameters) -> bool {
    let velocity = DVec2::new(parameters.speed_mps, parameters.strafe_mps);
    let (ground, body_mps) = if parameters.is_in_place { (velocity, 0.0) } else { (DVec2::ZERO, velocity.length()) };
    treadmill_speed::planted_share(clip, roles, ground, body_mps).is_some_and(|share| share > WALK_PLANTED_SHARE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic;

    /// The reason for a body after a change.
    fn reason(change: impl Fn(&mut HumanBody)) -> Option<RejectionReason> {
        let mut body = synthetic::body(1.0);
        change(&mut body);
        impossible_body(&body)
    }

    #[test]
    fn bodies_that_cannot_walk_are_rejected() {
        assert_eq!(reason(|_| ()), None);
        for scale in [1e-6, 7.0] {
            let scaled = reason(|body| body.offsets_m.iter_mut().for_each(|offset| *offset *= scale));
            assert!(matches!(scaled, Some(RejectionReason::LegLength { .. })), "{scaled:?}");
        }
        let short = reason(|body| body.offsets_m[Joint::LeftFoot.index()] *= 0.01);
        assert!(matches!(short, Some(RejectionReason::ShortLegBone { .. })), "{short:?}");
        let high = reason(|body| body.segment_ends_m[Joint::Head.index()].z = 1e6);
        assert!(matches!(high, Some(RejectionReason::LongBone { .. })), "{high:?}");
        let endless = reason(|body| body.soles_m[0][2].x = f64::INFINITY);
        assert!(matches!(endless, Some(RejectionReason::LongBone { .. })), "{endless:?}");
    }
}

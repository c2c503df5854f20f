//! Whether a gait and a body can be true.
//!
//! Of a gait: its cadence, and the ratio of step length to cadence, the walk ratio, which people keep at 0.6–0.7
//! cm/(step/min) over most speeds (Sekiya and Nagasaki 1998). A lying `Frame Time:` scales both: the CMU run 02_03 at
//! 1/25 s instead of 1/120 s comes out at 4. Legs of another length step longer by that length, at a cadence of its
//! root less. Of a body: its size, its bones, and whether it stands.

use glam::DVec2;
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Unfit, Warning};
use motiondb::statistics::median;

use crate::error::Refusal;
use crate::read::source_clip::SourceClip;
use crate::retarget::human_clip::HumanBody;
use crate::retarget::source_parameters::{WholeClip, facing_rad};
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, found_up, leg_length, middle};
use crate::rig::roles::Roles;

/// Plausible walk ratios, cm/(step/min), for a person's leg. Clips of the development set: 0.27 (careful small steps)
/// to 1.1 (sprint).
const WALK_RATIO_CM_MIN: std::ops::RangeInclusive<f64> = 0.15..=2.0;
/// The fastest steps a minute, for a person's leg (sprinters: 290).
const CADENCE_MAX_PER_MIN: f64 = 320.0;
/// The fastest steps a minute of a walk (race walkers over 20 km: 3.1 to 3.5 a second), and the share of the time from
/// which on the ball of a foot stands as in a walk: there from 12 to 60 % of the cycle (Perry, *Gait Analysis*), in
/// jogs for 0.4 of it.
const WALK_CADENCE_MAX_PER_MIN: f64 = 215.0;
const WALK_PLANTED_SHARE: f64 = 0.45;
/// Feet nearer along the facing do not step but stand, turn or side-step; shorter steps say nothing, m.
pub(crate) const LEAD_MIN_M: f64 = 0.06;
const STEP_MIN_M: f64 = 0.2;
/// Fewer steps say nothing.
const STEPS_MIN: usize = 3;

/// Thigh plus shank of all that walks, from a toy to a giant, m; a database takes no others.
const LEG_M: std::ops::RangeInclusive<f64> = 0.1..=2.9;
/// Least share of the leg that each of its two bones has: no knee bends with less. People: 0.47 to 0.53.
const LEG_BONE_SHARE_MIN: f64 = 0.15;
/// Longest other bone, or foot, over the leg. People: 0.5 (upper trunk); drawn characters with large heads: 1.
const BONE_OVER_LEG_MAX: f64 = 1.5;

/// Thigh plus shank of people from the age of four on (some 0.4 m) to the tallest, m.
const HUMAN_LEG_RANGE_M: std::ops::RangeInclusive<f64> = 0.38..=1.2;

/// The warning, where no human has legs of that length: speeds are as wrong as the unit then.
pub(crate) fn implausible_size(clip: &SourceClip, roles: &Roles) -> Option<Warning> {
    let leg_m = leg_length(clip, roles);
    (!HUMAN_LEG_RANGE_M.contains(&leg_m)).then_some(Warning::InhumanSize { leg_m: leg_m as f32 })
}

/// Drops the unit of the format, with a warning, where no body of that size could walk: the unit is found then.
pub(crate) fn doubt_unit(clip: &mut SourceClip, roles: &Roles) {
    let Some(metres_per_unit) = clip.metres_per_unit else { return };
    let leg_m = metres_per_unit * leg_length(clip, roles);
    if !LEG_M.contains(&leg_m) {
        clip.metres_per_unit = None;
        clip.diagnostics.push(Diagnostic::Warning(Warning::UnitRejected { leg_m: leg_m as f32 }));
    }
}

/// The verdict, where the body does not stand along the axis that a manifest states to be up.
pub(crate) fn contradicted_up(clip: &SourceClip, roles: &Roles) -> Option<Unfit> {
    let (stated, found) = (clip.up_axis?, found_up(clip, roles));
    (stated != found).then(|| Unfit::UpContradicted { stated: stated.name(), found: found.name() })
}

/// The refusal, where bones are none of a body that could walk.
pub(crate) fn impossible_body(body: &HumanBody) -> Option<Refusal> {
    let leg_m = body.leg_length_m();
    let leg_bones = [Joint::SHANKS, Joint::FEET].concat();
    let shortest_m = leg_bones.iter().map(|joint| body.offsets_m[joint.index()].length()).fold(f64::INFINITY, f64::min);
    let bones = body.offsets_m.iter().chain(&body.segment_ends_m).chain(body.soles_m.iter().flatten());
    let longest_m = bones.map(|bone| bone.length()).fold(0.0, f64::max);
    if !LEG_M.contains(&leg_m) {
        Some(Refusal::LegLength { leg_m })
    } else if shortest_m < LEG_BONE_SHARE_MIN * leg_m {
        Some(Refusal::ShortLegBone { leg_m, bone_m: shortest_m })
    } else if longest_m > BONE_OVER_LEG_MAX * leg_m {
        Some(Refusal::LongBone { leg_m, bone_m: longest_m })
    } else {
        None
    }
}

/// The verdict, where steps are none of a human's: the frame time is wrong, and with it all speeds.
pub(crate) fn inhuman_gait(clip: &SourceClip, roles: &Roles, whole: &WholeClip) -> Option<Unfit> {
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let passings = passings(clip, roles, LEAD_MIN_M * scale);
    let steps: Vec<(usize, usize)> = passings.windows(2).map(|pair| (pair[0], pair[1])).collect();
    if steps.len() < STEPS_MIN {
        return None;
    }
    // By strides: frames are too coarse for single steps, and limbs may be unequal.
    let step_s = median(passings.windows(3).map(|stride| (stride[2] - stride[0]) as f64))? / (2.0 * clip.frame_rate_hz);
    let hips = |frame: usize| middle(clip, roles, Joint::THIGHS, frame).truncate();
    let step_m = match whole.in_place {
        true => whole.speed_mps.abs() * step_s,
        false => median(steps.iter().map(|&(from, to)| (hips(to) - hips(from)).length()))?,
    };
    let (human_step_cm, human_cadence) = (100.0 * step_m / scale, 60.0 / step_s * scale.sqrt());
    let cadence_max = if walks(clip, roles, whole) { WALK_CADENCE_MAX_PER_MIN } else { CADENCE_MAX_PER_MIN };
    let is_human = human_step_cm < 100.0 * STEP_MIN_M
        || human_cadence < cadence_max && WALK_RATIO_CM_MIN.contains(&(human_step_cm / human_cadence));
    let [step_cm, steps_per_min] = [100.0 * step_m, 60.0 / step_s].map(|figure| figure as f32);
    (!is_human).then_some(Unfit::InhumanGait { step_cm, steps_per_min })
}

/// Whether feet stand as long as a walker's.
fn walks(clip: &SourceClip, roles: &Roles, whole: &WholeClip) -> bool {
    let speeds = DVec2::new(whole.speed_mps, whole.strafe_mps);
    let (ground, body_mps) = if whole.in_place { (speeds, 0.0) } else { (DVec2::ZERO, speeds.length()) };
    treadmill_speed::planted_share(clip, roles, ground, body_mps).is_some_and(|share| share > WALK_PLANTED_SHARE)
}

/// The frames in which one foot passes the other along the facing, once a step, and leads it by `lead_m` before the
/// next.
pub(crate) fn passings(clip: &SourceClip, roles: &Roles, lead_m: f64) -> Vec<usize> {
    let mut passings = Vec::new();
    let (mut leading, mut crossed) = (0.0, 0);
    for frame in 0..clip.frame_count() {
        let [left, right] = Joint::FEET.map(|foot| clip.position(frame, roles.required(foot)));
        let facing = facing_rad(clip, roles, frame);
        let lead = (left - right).x * libm::cos(facing) + (left - right).y * libm::sin(facing);
        if lead * leading <= 0.0 && crossed == 0 {
            crossed = frame;
        } else if lead * leading > 0.0 {
            crossed = 0;
        }
        if lead.abs() > lead_m && lead * leading <= 0.0 {
            passings.extend((leading != 0.0).then_some(crossed));
            (leading, crossed) = (lead, 0);
        }
    }
    passings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic;

    /// Why a changed body is refused.
    fn refusal(change: impl Fn(&mut HumanBody)) -> Option<Refusal> {
        let mut body = synthetic::body(1.0);
        change(&mut body);
        impossible_body(&body)
    }

    #[test]
    fn bodies_that_could_not_walk_are_refused() {
        assert_eq!(refusal(|_| ()), None);
        for scale in [1e-6, 7.0] {
            let scaled = refusal(|body| body.offsets_m.iter_mut().for_each(|offset| *offset *= scale));
            assert!(matches!(scaled, Some(Refusal::LegLength { .. })), "{scaled:?}");
        }
        let short = refusal(|body| body.offsets_m[Joint::LeftFoot.index()] *= 0.01);
        assert!(matches!(short, Some(Refusal::ShortLegBone { .. })), "{short:?}");
        let high = refusal(|body| body.segment_ends_m[Joint::Head.index()].z = 1e6);
        assert!(matches!(high, Some(Refusal::LongBone { .. })), "{high:?}");
        let endless = refusal(|body| body.soles_m[0][2].x = f64::INFINITY);
        assert!(matches!(endless, Some(Refusal::LongBone { .. })), "{endless:?}");
    }
}

//! The source's up axis and unit, from the posed body, and the clip in metres, z up.
//!
//! Zero poses and OFFSETs do not show the up axis: LaFAN1's bones all lie along +X, iClone's zero pose along Z. Up is
//! the axis nearest to the direction from feet to shoulders, averaged over all frames.
//!
//! The unit is the one of least misfit. Three misfits are added: of the leg, to a person's; of the cadence, to that of
//! legs of this length, which swing as pendulums do; and of the unit, to those that tools write. A step has the same
//! length in legs in every unit and tells nothing.

use std::ops::RangeInclusive;

use glam::{DQuat, DVec3};
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb::statistics::{median, percentile};

use crate::read::axis::Axis;
use crate::read::source_clip::SourceClip;
use crate::retarget::foot_passings::{LEAD_MIN_M, foot_passings};
use crate::rig::roles::Roles;

/// Thigh plus shank of a person, m: the median of the recorded performers of the development set.
pub const HUMAN_LEG_M: f64 = 0.84;
/// Weight of a leg that is too long, against one that is too short: performers are children more often than giants.
const TOO_LONG_WEIGHT: f64 = 1.6;
/// Units of sources, m, each with its misfit: metre, decimetre, centimetre, millimetre, inch, and 1/0.45 inch of the CMU
/// files. All misfits are logarithms of ratios. Few tools write the units of great misfit.
pub(crate) const UNITS: [(f64, f64); 6] =
    [(1.0, 0.0), (0.1, 0.5), (0.01, 0.0), (0.001, 0.5), (0.0254, 0.6), (0.0564444, 0.65)];
/// Strides per second times √(leg length / g), from a slow walk to a sprint (2.4 strides/s on legs of 0.84 m).
const CADENCE_RANGE: RangeInclusive<f64> = 0.17..=0.7;
/// Greatest misfit of a cadence: beyond 1.5 times the range the frame time is wrong, which says nothing of the unit.
const CADENCE_MISFIT_MAX: f64 = 0.4;
/// Possible leg lengths, thigh plus shank, m, where a usual unit competes with a rare one: an adult's legs in inches may be
/// those of a figure of 0.3 m in centimetres.
const POSSIBLE_LEG_M: RangeInclusive<f64> = 0.2..=2.9;
/// Gravity, m/s².
const GRAVITY_MPS2: f64 = 9.81;
/// Difference of misfits below which the second unit may be the right one: that of legs 1.34 times as long. Legs of an
/// adult of 2 m in decimetres are no doubt.
const NEAR_MISFIT: f64 = 0.29;

/// Share of the frames in which feet and shoulders are nearer than those that stand.
const LONGEST_PERCENTILE: f64 = 0.9;
/// Distance of feet and shoulders in a body that stands, divided by their distance when it stands straight.
const LONG_SHARE: f64 = 0.85;

/// Up axis and unit of a source.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceUnits {
    /// `+X` … `-Z`.
    pub up_axis: String,
    /// Metres of one source unit.
    pub metres_per_unit: f64,
}

/// The clip in metres, z up, and the up axis and unit that it had. Where another unit may be the right one, it gets a
/// warning.
pub fn to_metres_z_up(mut clip: SourceClip, roles: &Roles) -> (SourceClip, SourceUnits) {
    let up = clip.up_axis.unwrap_or_else(|| found_up(&clip, roles));
    let turn = DQuat::from_rotation_arc(up.direction(), DVec3::Z);
    for position in &mut clip.positions {
        *position = turn * *position;
    }
    for orientation in &mut clip.orientations {
        *orientation = turn * *orientation;
    }
    let metres_per_unit = clip.metres_per_unit.unwrap_or_else(|| found_unit_m(&mut clip, roles));
    clip.positions.iter_mut().for_each(|position| *position *= metres_per_unit);
    (clip, SourceUnits { up_axis: up.name(), metres_per_unit })
}

/// The likeliest unit of a clip with z up, m; adds a warning if another may be the right one.
fn found_unit_m(clip: &mut SourceClip, roles: &Roles) -> f64 {
    let leg_units = leg_length(clip, roles);
    let units = likeliest_units(leg_units, strides_hz(clip, roles, leg_units));
    if let Some(other) = doubt(&units) {
        let [leg_m, other_leg_m] = [units[0], other].map(|unit| unit.leg_m as f32);
        let other_unit_m = other.unit_m;
        clip.diagnostics.push(Diagnostic::Warning(Warning::UnitDoubtful { leg_m, other_leg_m, other_unit_m }));
    }
    units[0].unit_m
}

/// The unit that may be right in place of the likeliest: one that is nearly as likely, or a usual one where the likeliest is
/// rare.
fn doubt(units: &[UnitMisfit]) -> Option<UnitMisfit> {
    let (best, others) = units.split_first()?;
    let is_usual = |unit: &UnitMisfit| unit.unit_misfit == 0.0 && POSSIBLE_LEG_M.contains(&unit.leg_m);
    let near = others.first().filter(|second| second.misfit - best.misfit < NEAR_MISFIT);
    near.or_else(|| others.iter().find(|other| best.unit_misfit > 0.0 && is_usual(other))).copied()
}

/// Removes the doubt about the unit of a clip in metres whose frame time is wrong, unless its legs alone give one: the
/// cadence says nothing of the unit then.
pub(crate) fn drop_doubt_of_cadence(clip: &mut SourceClip, roles: &Roles, metres_per_unit: f64) {
    if doubt(&likeliest_units(leg_length(clip, roles) / metres_per_unit, None)).is_none() {
        clip.diagnostics.retain(|found| !matches!(found, Diagnostic::Warning(Warning::UnitDoubtful { .. })));
    }
}

/// Strides per second; none of a clip of fewer than three steps.
fn strides_hz(clip: &SourceClip, roles: &Roles, leg_units: f64) -> Option<f64> {
    let passings = foot_passings(clip, roles, LEAD_MIN_M / HUMAN_LEG_M * leg_units);
    let stride_frames = median(passings.windows(3).map(|stride| (stride[2] - stride[0]) as f64))?;
    Some(clip.frame_rate_hz / stride_frames)
}

/// Midpoint of a pair of roles in one frame.
pub(crate) fn middle(clip: &SourceClip, roles: &Roles, pair: [Joint; 2], frame: usize) -> DVec3 {
    0.5 * pair.map(|joint| clip.position(frame, roles.required(joint))).into_iter().sum::<DVec3>()
}

/// The up axis as the body stands: the axis nearest to the mean direction from feet to shoulders, over the frames in
/// which these are nearly farthest apart. Where the body kneels or crawls they are nearer.
pub(crate) fn found_up(clip: &SourceClip, roles: &Roles) -> Axis {
    let body = |frame| middle(clip, roles, Joint::UPPER_ARMS, frame) - middle(clip, roles, Joint::FEET, frame);
    let frames = 0..clip.frame_count();
    let longest = percentile(frames.clone().map(|frame| body(frame).length()), LONGEST_PERCENTILE).unwrap_or_default();
    Axis::nearest(frames.map(body).filter(|body| body.length() >= LONG_SHARE * longest).sum())
}

/// Thigh plus shank in the clip's unit, mean of both sides and all frames.
pub(crate) fn leg_length(clip: &SourceClip, roles: &Roles) -> f64 {
    let bone = |frame, from: Joint, to: Joint| {
        (clip.position(frame, roles.required(from)) - clip.position(frame, roles.required(to))).length()
    };
    let leg = |frame, side: usize| {
        bone(frame, Joint::THIGHS[side], Joint::SHANKS[side]) + bone(frame, Joint::SHANKS[side], Joint::FEET[side])
    };
    let sum: f64 = (0..clip.frame_count()).map(|frame| 0.5 * (leg(frame, 0) + leg(frame, 1))).sum();
    sum / clip.frame_count() as f64
}

/// A unit and its misfits.
#[derive(Clone, Copy)]
struct UnitMisfit {
    unit_m: f64,
    /// Length of the legs in this unit, m.
    leg_m: f64,
    /// Misfit of the unit itself: few tools write it.
    unit_misfit: f64,
    /// Misfit of unit, leg and cadence.
    misfit: f64,
}

/// All units of a body whose legs are this many units long, the likeliest first.
fn likeliest_units(leg_units: f64, strides_hz: Option<f64>) -> [UnitMisfit; UNITS.len()] {
    let mut units = UNITS.map(|(unit_m, unit_misfit)| {
        let leg_m = leg_units * unit_m;
        let cadence_misfit = strides_hz.map_or(0.0, |hz| cadence_misfit(leg_m, hz));
        UnitMisfit { unit_m, leg_m, unit_misfit, misfit: leg_misfit(leg_m) + cadence_misfit + unit_misfit }
    });
    units.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    units
}

/// How unlike a person's a leg is.
fn leg_misfit(leg_m: f64) -> f64 {
    let log = libm::log(leg_m / HUMAN_LEG_M);
    f64::max(-log, TOO_LONG_WEIGHT * log)
}

/// How far a cadence lies outside those of legs of this length.
fn cadence_misfit(leg_m: f64, strides_hz: f64) -> f64 {
    let cadence = strides_hz * (leg_m / GRAVITY_MPS2).sqrt();
    let (slow, fast) = (libm::log(CADENCE_RANGE.start() / cadence), libm::log(cadence / CADENCE_RANGE.end()));
    slow.max(fast).clamp(0.0, CADENCE_MISFIT_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check_unit(leg_m: f64, unit_m: f64, strides_hz: Option<f64>) {
        let found_m = likeliest_units(leg_m / unit_m, strides_hz)[0].unit_m;
        assert_eq!(found_m, unit_m, "{leg_m} m in units of {unit_m} m, {strides_hz:?} strides/s");
    }

    #[test]
    fn units_of_adults_and_children_are_found() {
        for (unit_m, _) in UNITS {
            for leg_m in [0.75, 0.84, 0.95] {
                check_unit(leg_m, unit_m, None);
                check_unit(leg_m, unit_m, Some(0.95));
            }
        }
        // Children of four and five. In inches, or in 1/0.45 inch, the same numbers would be legs of 1.0 to 1.3 m.
        for unit_m in [1.0, 0.01, 0.001] {
            for leg_m in [0.38, 0.40, 0.45, 0.515] {
                check_unit(leg_m, unit_m, None);
                check_unit(leg_m, unit_m, Some(0.9));
            }
        }
        check_unit(2.4, 1.0, None);
        check_unit(2.4, 0.01, Some(0.6));
    }

    #[test]
    fn a_cadence_tells_an_inch_from_a_centimetre() {
        // A leg of 36 units has 0.36 m or 0.91 m. Legs of 0.36 m come near to 4 strides/s; longer ones do not.
        check_unit(0.36, 0.01, Some(4.0));
        check_unit(0.91, 0.0254, Some(0.9));
    }

    #[test]
    fn wrong_frame_times_leave_the_unit() {
        for (unit_m, leg_m) in [(0.0254, 0.8), (0.0564444, 0.84), (0.1, 0.84), (0.01, 0.75)] {
            for factor in [0.1, 0.25, 1.0, 4.8, 10.0] {
                check_unit(leg_m, unit_m, Some(1.3 * factor));
            }
        }
    }
}

//! The source's up axis and unit, from the posed body, and the clip in metres, z up.
//!
//! Zero poses and OFFSETs do not show the up axis: LaFAN1's bones all lie along +X, iClone's zero pose along Z. Up is
//! the axis nearest to the direction from feet to shoulders, averaged over all frames. The unit is the one that brings
//! thigh plus shank nearest to a person's.

use glam::{DQuat, DVec3};
use motiondb::body::Joint;
use motiondb::statistics::percentile;

use crate::read::axis::Axis;
use crate::read::source_clip::SourceClip;
use crate::rig::roles::Roles;

/// Thigh plus shank of a person, m: the median of the recorded performers of the development set.
pub const HUMAN_LEG_M: f64 = 0.84;
/// Weight of a leg that is too long, against one that is too short: performers are children more often than giants.
const TOO_LONG_WEIGHT: f64 = 2.0;
/// Units of sources, m: metre, decimetre, centimetre, millimetre, inch, and 1/0.45 inch of the CMU files.
const UNITS_M: [f64; 6] = [1.0, 0.1, 0.01, 0.001, 0.0254, 0.0564444];

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

/// The clip in metres, z up, and the up axis and unit that it had.
pub fn to_metres_z_up(mut clip: SourceClip, roles: &Roles) -> (SourceClip, SourceUnits) {
    let up = clip.up_axis.unwrap_or_else(|| found_up(&clip, roles));
    let metres_per_unit = clip.metres_per_unit.unwrap_or_else(|| nearest_unit_m(leg_length(&clip, roles)));
    let turn = DQuat::from_rotation_arc(up.direction(), DVec3::Z);
    for position in &mut clip.positions {
        *position = turn * *position * metres_per_unit;
    }
    for orientation in &mut clip.orientations {
        *orientation = turn * *orientation;
    }
    (clip, SourceUnits { up_axis: up.name(), metres_per_unit })
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

/// The unit, m, that brings a leg of this many units nearest to a person's.
fn nearest_unit_m(leg_units: f64) -> f64 {
    let misfit = |unit: f64| {
        let log = libm::log(leg_units * unit / HUMAN_LEG_M);
        f64::max(-log, TOO_LONG_WEIGHT * log)
    };
    UNITS_M.into_iter().min_by(|&a, &b| misfit(a).total_cmp(&misfit(b))).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_adults_and_children_are_found() {
        for unit in UNITS_M {
            for leg_m in [0.75, 0.84, 0.95] {
                assert_eq!(nearest_unit_m(leg_m / unit), unit, "{leg_m} m in units of {unit} m");
            }
        }
        // A child of five. In 1/0.45 inch, the same number would be a leg of 1.14 m.
        for unit in [1.0, 0.01, 0.001, 0.0254] {
            assert_eq!(nearest_unit_m(0.515 / unit), unit, "in units of {unit} m");
        }
    }
}

//! GaitWindow → SteadyCycle: what an example can be made of, or why the window is unfit.
//!
//! A folder may hold anything: dances, jumps, deaths. A clip that steps or stands steadily may still be no model of
//! standing on the ground, and then gives no example. Windows in frames of the clip, cycles in the root frame: metres,
//! seconds.

use std::ops::Range;

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Unfit};
use motiondb::validate::is_open;
use serde::{Deserialize, Serialize};

use crate::cycle::flaws::{flaws_of_rest, flaws_of_strides};
use crate::cycle::foot_slide::{foot_slide, foot_warnings, unfit_feet};
use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::posture_warnings::{bent_trunk, posture_warnings};
use crate::cycle::rate_snapping::snap_rates;
use crate::cycle::rest::Rest;
use crate::gait::stride::Stride;
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Least height of the pelvis of a body that walks, crouched or on hands, m.
const PELVIS_HEIGHT_MIN_M: f64 = 0.01;
/// Greatest height of the pelvis, leg lengths.
const PELVIS_HEIGHT_MAX_LEGS: f64 = 3.0;
/// Greatest horizontal distance of the pelvis from its root, leg lengths.
const PELVIS_ASIDE_MAX_LEGS: f64 = 2.0;

/// A steady window of a clip, as its example shows it.
#[derive(Serialize, Deserialize)]
pub(crate) struct SteadyCycle {
    /// First and last second of the window, from the file's first frame.
    pub(crate) window_s: [f64; 2],
    /// What the body does in the window.
    pub(crate) motion: SteadyMotion,
    /// Distance from a clean cycle, see [`crate::cycle::flaws`].
    pub(crate) flaws: f64,
    /// The feet deserve a warning: good enough for the only example of a clip, but not for a further one.
    pub(crate) is_doubtful: bool,
    /// Diagnostics for the clip's record, if the window becomes an example.
    pub(crate) diagnostics: Vec<Diagnostic>,
}

/// What a body does in a steady window.
#[derive(Serialize, Deserialize)]
pub(crate) enum SteadyMotion {
    /// It steps: the mean stride.
    Steps(Box<GaitCycle>),
    /// It stands in these frames; the cycle is made later, with the period of m_sp.
    Stands(Range<usize>),
}

impl SteadyCycle {
    /// The steady cycle of a window of strides, by their mean, on a body `growth` times as large as the performer.
    ///
    /// # Errors
    /// Why the cycle must not be blended with others.
    pub(crate) fn of_strides(
        mut cycle: GaitCycle,
        strides: &[Stride],
        body: &HumanBody,
        growth: f64,
        window_s: [f64; 2],
    ) -> Result<Self, Unfit> {
        let mut diagnostics = snap_rates(&mut cycle);
        let slide = foot_slide(&cycle, body);
        if leaves_root(cycle.rows.iter().map(|row| row.pelvis_m), body) {
            return Err(Unfit::PelvisOutOfReach);
        }
        let [seam_rad, largest_rad] = turns_rad(&cycle);
        if is_open(seam_rad, largest_rad) {
            return Err(Unfit::CycleOpen { seam_rad, largest_rad });
        }
        if let Some(unfit) = unfit_feet(&cycle, body, growth, &slide) {
            return Err(unfit);
        }
        let warnings = foot_warnings(&cycle.rates, &slide);
        let is_doubtful = !warnings.is_empty();
        diagnostics.extend(warnings);
        diagnostics.extend(posture_warnings(&cycle, body));
        let flaws = flaws_of_strides(strides, &cycle.rates, &slide);
        Ok(Self { window_s, motion: SteadyMotion::Steps(Box::new(cycle)), flaws, is_doubtful, diagnostics })
    }

    /// The steady cycle of frames in which the body stands.
    ///
    /// # Errors
    /// If the pelvis leaves its legs, or the arms are spread or raised.
    pub(crate) fn of_rest(
        clip: &GroundedClip,
        frames: &Range<usize>,
        body: &HumanBody,
        window_s: [f64; 2],
    ) -> Result<Self, Unfit> {
        let heights_m = frames.clone().map(|frame| DVec3::Z * clip.pose(frame).pelvis_m.z);
        if leaves_root(heights_m, body) {
            return Err(Unfit::PelvisOutOfReach);
        }
        let rest = Rest::of(clip, frames, body);
        if let Some(unfit) = rest.unfit() {
            return Err(unfit);
        }
        let flaws = flaws_of_rest(&rest);
        let motion = SteadyMotion::Stands(frames.clone());
        Ok(Self {
            window_s,
            motion,
            flaws,
            is_doubtful: false,
            diagnostics: bent_trunk(rest.lean_deg).into_iter().collect(),
        })
    }

    /// The mean stride of a body that steps.
    pub(crate) fn stepping(&self) -> Option<&GaitCycle> {
        match &self.motion {
            SteadyMotion::Steps(cycle) => Some(cycle),
            SteadyMotion::Stands(_) => None,
        }
    }

    /// The frames in which the body stands.
    pub(crate) fn standing(&self) -> Option<&Range<usize>> {
        match &self.motion {
            SteadyMotion::Steps(_) => None,
            SteadyMotion::Stands(frames) => Some(frames),
        }
    }

    /// Constant rates of the root.
    pub(crate) fn rates(&self) -> Rates {
        self.stepping().map_or_else(Rates::default, |cycle| cycle.rates)
    }
}

/// Greatest turn of a joint from the last row to the first, and from row to row within the cycle, rad.
fn turns_rad(cycle: &GaitCycle) -> [f32; 2] {
    let turn_rad = |(from, to): (&HumanPose, &HumanPose)| {
        let angles = from.rotations.iter().zip(&to.rotations).map(|(from, to)| from.angle_between(*to));
        angles.fold(0.0, f64::max) as f32
    };
    let rows = &cycle.rows;
    let largest_rad = rows.iter().zip(&rows[1..]).map(turn_rad).fold(0.0, f32::max);
    [turn_rad((&rows[rows.len() - 1], &rows[0])), largest_rad]
}

/// Whether a pelvis, in the root frame, lies too far aside, too high or in the ground.
fn leaves_root(mut pelvis_m: impl Iterator<Item = DVec3>, body: &HumanBody) -> bool {
    let leg_m = body.leg_length_m();
    let heights_m = PELVIS_HEIGHT_MIN_M..PELVIS_HEIGHT_MAX_LEGS * leg_m;
    let is_near = |position_m: DVec3| {
        position_m.truncate().length() < PELVIS_ASIDE_MAX_LEGS * leg_m && heights_m.contains(&position_m.z)
    };
    !pelvis_m.all(is_near)
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use motiondb::body::Joint;

    use super::*;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    #[test]
    fn a_cycle_whose_end_jumps_to_its_beginning_is_open() {
        let is_open_of = |cycle: &GaitCycle| {
            let [seam_rad, largest_rad] = turns_rad(cycle);
            is_open(seam_rad, largest_rad)
        };
        let mut cycle = cycle_of(&synthetic::walk("walk", SyntheticWalk::default()));
        assert!(!is_open_of(&cycle));
        for (row, pose) in cycle.rows.iter_mut().enumerate() {
            let spine = &mut pose.rotations[Joint::SpineUpper.index()];
            *spine = DQuat::from_rotation_z(0.02 * row as f64) * *spine;
        }
        assert!(is_open_of(&cycle));
    }
}

//! No two strides are the same: seeded, small changes of every quantity from stride to stride.
//!
//! Each quantity changes as a sum of waves that are slower than the stride and close over the clip ([`SlowChange`]): the
//! mean change over its strides is zero, so that the mean stride is the planned one. The duration of a stride
//! changes with the clock by which the gait runs ([`StrideVariation::strides_after`]), its length with the path of the
//! root by that clock ([`StrideVariation::path_strides`]). Feet are set where the root then is, and stand.

use crate::plan::gait_plan::{PelvisAmplitudes, UpperBodyAmplitudes};
use crate::plan::slow_change::SlowChange;

/// Coefficient of variation of the stride's duration: 1.3 ± 0.1 % in young adults (Hausdorff et al. 1999, *J. Appl.
/// Physiol.* 86, 1040–1047), usually below 3 % (Beauchet et al. 2009, *J. NeuroEng. Rehabil.* 6:32).
const STRIDE_TIME_CV: f64 = 0.013;
/// Coefficient of variation of the stride's length, assumed equal to that of its duration.
const STRIDE_LENGTH_CV: f64 = 0.013;
/// Sideways displacement of each foot, root mean square, m: step widths then vary by 1.4 cm, within the 1.97 cm that a
/// review of ten studies finds usual (Skiadopoulos et al. 2020, *J. NeuroEng. Rehabil.* 17).
const ASIDE_M: f64 = 0.010;
/// Change of a foot's yaw, root mean square, rad; set by eye.
const FOOT_YAW_RAD: f64 = 0.014;
/// Change of a foot's lift, root mean square, m; set by eye, far within a toe clearance of 1.3 cm.
const LIFT_M: f64 = 0.002;
/// Change of the pelvis's sway, list and rotation, share of each; set by eye.
const PELVIS_SHARE: f64 = 0.05;
/// Change of the arm swing, share; set by eye within the 5–10 % of healthy adults.
const ARM_SHARE: f64 = 0.06;
/// Change of the elbow's bend, share; set by eye.
const ELBOW_SHARE: f64 = 0.04;
/// Change of the chest's yaw, share; set by eye.
const CHEST_SHARE: f64 = 0.06;
/// Change of the gaze, root mean square, rad; set by eye.
const LOOK_RAD: f64 = 0.012;

/// The changes of one clip from stride to stride.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrideVariation {
    change: SlowChange,
    strides: usize,
}

/// The changes of one step from the steady gait.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepChange {
    /// Displacement of the foot to the left, m.
    pub(crate) aside_m: f64,
    /// Turn of the toes to the left, rad.
    pub(crate) yaw_rad: f64,
    /// Additional lift of the swing that ends with the step, m.
    pub(crate) lift_m: f64,
}

impl StrideVariation {
    /// The changes of the clip of this name.
    pub(crate) fn of_clip(name: &str, strides: usize) -> Self {
        Self { change: SlowChange::of_clip(name, strides - 1), strides }
    }

    /// Whole strides of the clip.
    pub(crate) fn strides(&self) -> usize {
        self.strides
    }

    /// Strides that are done when `steady` ones would be done without variation.
    pub(crate) fn strides_after(&self, steady: f64) -> f64 {
        steady + STRIDE_TIME_CV * (self.change_by_stride(4, steady) - self.change_by_stride(4, 0.0))
    }

    /// Distance of the root along its path at a phase, in lengths of a stride.
    pub(crate) fn path_strides(&self, phase: f64) -> f64 {
        phase + STRIDE_LENGTH_CV * self.change_by_stride(5, phase)
    }

    /// The changes of the step of one side that begins at a strike (phase, strides).
    pub(crate) fn of_step(&self, side: usize, strike: f64) -> StepChange {
        let noise = |channel: u64| self.noise(6 + 3 * side as u64 + channel, strike);
        StepChange { aside_m: ASIDE_M * noise(0), yaw_rad: FOOT_YAW_RAD * noise(1), lift_m: LIFT_M * noise(2) }
    }

    /// The pelvis's amplitudes at a phase.
    pub(crate) fn of_pelvis(&self, steady: &PelvisAmplitudes, phase: f64) -> PelvisAmplitudes {
        let changed = |value: f64, channel: u64| value * (1.0 + PELVIS_SHARE * self.noise(channel, phase));
        PelvisAmplitudes {
            sway_m: changed(steady.sway_m, 12),
            list_rad: changed(steady.list_rad, 13),
            rotation_rad: changed(steady.rotation_rad, 14),
            ..*steady
        }
    }

    /// The upper body's amplitudes at a phase.
    pub(crate) fn of_upper_body(&self, steady: &UpperBodyAmplitudes, phase: f64) -> UpperBodyAmplitudes {
        let changed = |value: f64, share: f64, channel: u64| value * (1.0 + share * self.noise(channel, phase));
        UpperBodyAmplitudes {
            arm_swing_rad: changed(steady.arm_swing_rad, ARM_SHARE, 0),
            elbow_rad: changed(steady.elbow_rad, ELBOW_SHARE, 1),
            chest_yaw_rad: changed(steady.chest_yaw_rad, CHEST_SHARE, 2),
            look_rad: steady.look_rad + LOOK_RAD * self.noise(3, phase),
            ..*steady
        }
    }

    /// A value that changes from each stride to the next by a mean square of 1.
    fn change_by_stride(&self, channel: u64, strides: f64) -> f64 {
        // A wave of k periods over S strides changes by 2 sin(πk/S) of itself; the mean of the squares is 2S/(S − 1).
        let count = self.strides as f64;
        libm::sqrt((count - 1.0) / (2.0 * count)) * self.noise(channel, strides)
    }

    /// A value of mean 0 and mean square 1 over the clip.
    fn noise(&self, channel: u64, strides: f64) -> f64 {
        self.change.at(channel, strides / self.strides as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stride_durations_vary_by_the_published_share() {
        for strides in [3, 4, 6] {
            let variation = StrideVariation::of_clip("walk", strides);
            let changes = (0..400).map(|i| f64::from(i) * strides as f64 / 400.0).map(|t| {
                let change = variation.strides_after(t + 1.0) - variation.strides_after(t) - 1.0;
                change * change / 400.0
            });
            assert!((libm::sqrt(changes.sum::<f64>()) - STRIDE_TIME_CV).abs() < 1e-9);
        }
    }
}

//! No two strides are the same: seeded, small changes of everything from stride to stride.
//!
//! Each changes as a sum of waves that are slower than the stride and close over the clip, so a clip still loops, and
//! their mean over its strides is nothing: the mean stride is the planned one. The stride's time and length change with
//! the clock by which the gait runs ([`Variation::strides_after`]) and with the way of the root by that clock
//! ([`Variation::way_strides`]); feet are put down where the root then is, and stand.

use crate::cadence::{PelvisSwing, UpperBodySwing};
use crate::rotation::wave;

/// Coefficient of variation of the stride's time: 1.3 ± 0.1 % in young adults (Hausdorff et al. 1999, *J. Appl.
/// Physiol.* 86, 1040–1047), usually below 3 % (Beauchet et al. 2009, *J. NeuroEng. Rehabil.* 6:32).
const STRIDE_TIME_CV: f64 = 0.013;
/// The same of its length, which is taken to vary as much.
const STRIDE_LENGTH_CV: f64 = 0.013;
/// Sideways, each foot, root mean square, m: step widths then vary by 1.4 cm, below the 1.97 cm up to which a review of
/// ten studies calls it usual (Skiadopoulos et al. 2020, *J. NeuroEng. Rehabil.* 17).
const ASIDE_M: f64 = 0.010;
/// Of the foot's yaw, radians, and of its lift, m: set by the eye, far within a toe clearance of 1.3 cm.
const FOOT_YAW_RAD: f64 = 0.014;
const LIFT_M: f64 = 0.002;
/// As a share of the pelvis's sway, list and rotation, of arm swing, elbow bend and chest yaw (the spread of healthy
/// adults' arm swings from stride to stride is some 5–10 %; set within it by the eye), and of the gaze, radians.
const PELVIS_SHARE: f64 = 0.05;
const ARM_SHARE: f64 = 0.06;
const ELBOW_SHARE: f64 = 0.04;
const CHEST_SHARE: f64 = 0.06;
const LOOK_RAD: f64 = 0.012;

/// The changes of one clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variation {
    seed: u64,
    strides: usize,
}

/// What is unlike the steady gait in one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepChange {
    /// To the left, m.
    pub(crate) aside_m: f64,
    /// Of the toes, to the left, radians.
    pub(crate) yaw_rad: f64,
    /// Of the swing that leads here, upward, m.
    pub(crate) lift_m: f64,
}

impl Variation {
    /// Of the clip of this name.
    pub(crate) fn of_clip(name: &str, strides: usize) -> Self {
        // FNV-1a.
        let seed = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        Self { seed, strides }
    }

    /// Whole strides of the clip.
    pub(crate) fn strides(&self) -> usize {
        self.strides
    }

    /// How many strides are done when steady ones would be so many.
    pub(crate) fn strides_after(&self, steady: f64) -> f64 {
        steady + STRIDE_TIME_CV * (self.change_by_stride(4, steady) - self.change_by_stride(4, 0.0))
    }

    /// The root's way at a phase, in strides' lengths.
    pub(crate) fn way_strides(&self, phase: f64) -> f64 {
        phase + STRIDE_LENGTH_CV * self.change_by_stride(5, phase)
    }

    /// One step, told by its side and its strike.
    pub(crate) fn of_step(&self, side: usize, strike: f64) -> StepChange {
        let noise = |channel: u64| self.noise(6 + 3 * side as u64 + channel, strike);
        StepChange { aside_m: ASIDE_M * noise(0), yaw_rad: FOOT_YAW_RAD * noise(1), lift_m: LIFT_M * noise(2) }
    }

    /// The pelvis's amplitudes at a phase.
    pub(crate) fn of_pelvis(&self, steady: &PelvisSwing, phase: f64) -> PelvisSwing {
        let changed = |value: f64, channel: u64| value * (1.0 + PELVIS_SHARE * self.noise(channel, phase));
        PelvisSwing {
            sway_m: changed(steady.sway_m, 12),
            list_rad: changed(steady.list_rad, 13),
            rotation_rad: changed(steady.rotation_rad, 14),
            ..*steady
        }
    }

    /// The upper body's amplitudes at a phase.
    pub(crate) fn of_upper_body(&self, steady: &UpperBodySwing, phase: f64) -> UpperBodySwing {
        let changed = |value: f64, share: f64, channel: u64| value * (1.0 + share * self.noise(channel, phase));
        UpperBodySwing {
            arm_swing_rad: changed(steady.arm_swing_rad, ARM_SHARE, 0),
            elbow_rad: changed(steady.elbow_rad, ELBOW_SHARE, 1),
            chest_yaw_rad: changed(steady.chest_yaw_rad, CHEST_SHARE, 2),
            look_rad: steady.look_rad + LOOK_RAD * self.noise(3, phase),
            ..*steady
        }
    }

    /// What changes from each stride to the next by a mean square of 1.
    fn change_by_stride(&self, channel: u64, strides: f64) -> f64 {
        // A wave of k periods over S strides changes by 2 sin(πk/S) of itself; the mean of the squares is 2S/(S − 1).
        let count = self.strides as f64;
        libm::sqrt((count - 1.0) / (2.0 * count)) * self.noise(channel, strides)
    }

    /// Of mean 0 and mean square 1 over the clip.
    fn noise(&self, channel: u64, strides: f64) -> f64 {
        let clip_share = strides / self.strides as f64;
        let waves = self.strides - 1;
        let of_wave = |k: usize| wave(k as f64 * clip_share - self.random(channel * 16 + k as u64));
        libm::sqrt(2.0 / waves as f64) * (1..=waves).map(of_wave).sum::<f64>()
    }

    /// In [0, 1): SplitMix64.
    fn random(&self, index: u64) -> f64 {
        let mut z = self.seed.wrapping_add((index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_have_no_mean_and_close_over_the_clip() {
        let variation = Variation::of_clip("walk", 4);
        let values: Vec<f64> = (0..400).map(|i| variation.noise(0, f64::from(i) / 100.0)).collect();
        assert!(values.iter().sum::<f64>().abs() < 1e-9);
        assert!((values.iter().map(|value| value * value).sum::<f64>() / 400.0 - 1.0).abs() < 1e-9);
        assert!((variation.noise(0, 4.0) - values[0]).abs() < 1e-9);
    }

    #[test]
    fn strides_take_unlike_times_by_the_published_share() {
        for strides in [3, 4, 6] {
            let variation = Variation::of_clip("walk", strides);
            let changes = (0..400).map(|i| f64::from(i) * strides as f64 / 400.0).map(|t| {
                let change = variation.strides_after(t + 1.0) - variation.strides_after(t) - 1.0;
                change * change / 400.0
            });
            assert!((libm::sqrt(changes.sum::<f64>()) - STRIDE_TIME_CV).abs() < 1e-9);
        }
    }
}

//! No two strides are the same: seeded, small changes of arms, trunk and gaze from stride to stride.
//!
//! Each changes as a sum of waves that are slower than the stride and close over the clip, so a clip still loops, and
//! their mean over its strides is nothing. Feet and pelvis stay as planned: what they are planned for (standing feet,
//! the clip's parameters) leaves no room.

use crate::cadence::UpperBodySwing;
use crate::rotation::wave;

/// Root mean square of the changes: as a share of arm swing, elbow bend and chest yaw (the spread of healthy adults'
/// arm swings from stride to stride is some 5–10 %; set within it by the eye), and of the gaze, radians.
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

impl Variation {
    /// Of the clip of this name.
    pub(crate) fn of_clip(name: &str, strides: usize) -> Self {
        // FNV-1a.
        let seed = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        Self { seed, strides }
    }

    /// The upper body's amplitudes after so many strides.
    pub(crate) fn of_upper_body(&self, steady: &UpperBodySwing, strides: f64) -> UpperBodySwing {
        let changed = |value: f64, share: f64, channel: u64| value * (1.0 + share * self.noise(channel, strides));
        UpperBodySwing {
            arm_swing_rad: changed(steady.arm_swing_rad, ARM_SHARE, 0),
            elbow_rad: changed(steady.elbow_rad, ELBOW_SHARE, 1),
            chest_yaw_rad: changed(steady.chest_yaw_rad, CHEST_SHARE, 2),
            look_rad: steady.look_rad + LOOK_RAD * self.noise(3, strides),
            ..*steady
        }
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
}

//! Slow changes of a quantity over a clip: sums of waves that close over it, so that the clip still loops.

use crate::body::rotation::wave;

/// The slow changes of the quantities of one clip, each on its own channel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlowChange {
    seed: u64,
    /// Waves of each sum; the fastest has so many periods over the clip.
    waves: usize,
}

impl SlowChange {
    /// The changes of the clip of this name.
    pub(crate) fn of_clip(name: &str, waves: usize) -> Self {
        assert!((1..16).contains(&waves), "{waves} waves: the channels hold 1 to 15");
        // FNV-1a.
        let seed = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        Self { seed, waves }
    }

    /// A value of mean 0 and mean square 1 over the clip, at a share of its duration.
    pub(crate) fn at(&self, channel: u64, clip_share: f64) -> f64 {
        let of_wave = |k: usize| wave(k as f64 * clip_share - self.random(channel * 16 + k as u64));
        libm::sqrt(2.0 / self.waves as f64) * (1..=self.waves).map(of_wave).sum::<f64>()
    }

    /// A random number in [0, 1): SplitMix64.
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
        let change = SlowChange::of_clip("walk", 3);
        let values: Vec<f64> = (0..400).map(|i| change.at(0, f64::from(i) / 400.0)).collect();
        assert!(values.iter().sum::<f64>().abs() < 1e-9);
        assert!((values.iter().map(|value| value * value).sum::<f64>() / 400.0 - 1.0).abs() < 1e-9);
        assert!((change.at(0, 1.0) - values[0]).abs() < 1e-9);
    }
}

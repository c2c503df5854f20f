//! SplitMix64 (Steele, Lea, Flood 2014): a seeded random number generator with the same numbers on every machine.

/// A generator; its state advances by the golden ratio with each number.
#[derive(Clone, Copy, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// A generator for a stream of a seed. Different streams of one seed are unrelated.
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Self(seed).next_u64() ^ Self(!stream).next_u64())
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        // 53 bits, the mantissa of an f64: every value is exact.
        (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [−range, range).
    pub fn within(&mut self, range: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_match_the_published_sequence() {
        let mut generator = SplitMix64(1_234_567);
        let drawn = [generator.next_u64(), generator.next_u64(), generator.next_u64()];
        assert_eq!(drawn, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }
}

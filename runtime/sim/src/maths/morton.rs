//! Morton codes: positions along a curve that fills the plane.

/// Position along a Z-shaped curve that fills the plane: points with close codes lie near each other.
pub(crate) fn morton_code(x: u32, y: u32) -> u64 {
    let spread = |bits: u32| {
        let mut bits = u64::from(bits);
        for (shift, mask) in [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(x) | spread(y) << 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn morton_codes_interleave_bits() {
        assert_eq!([morton_code(0b11, 0), morton_code(0, 0b101), morton_code(u32::MAX, u32::MAX)], [5, 34, u64::MAX]);
    }
}

//! e^(−x) and a soft maximum, where they are needed many times: without a branch, a table or a call, so that vector
//! instructions come of it.
//!
//! Operations that IEEE 754 rounds exactly, so the bits are the same on every machine.

use std::f32::consts::{LN_2, LOG2_E};

/// 1.5 · 2²³: added to a small number it leaves the nearest whole number in the lowest bits.
const WHOLE: f32 = 12_582_912.0;
/// The least power of two that is not denormal.
const POWER_MIN: f32 = -126.0;

/// e^(−x) for x ≥ 0, to 3e−7 of its value; no less than 2⁻¹²⁶, also of what is no number.
#[inline]
pub(crate) fn decay(x: f32) -> f32 {
    let power = -x * LOG2_E;
    let power = if power > POWER_MIN { power } else { POWER_MIN };
    let shifted = power + WHOLE;
    let whole_power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(1.0_f32.to_bits()));
    // Taylor's series within ±½ ln 2, where seven terms suffice.
    let part = (power - (shifted - WHOLE)) * LN_2;
    let terms = [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    whole_power * terms.into_iter().fold(0.0, |sum, term| sum * part + term)
}

/// ½(x + √(x² + 4)), a soft maximum of x and 0: 1 at 0, and less than 1/|x| off the maximum elsewhere.
#[inline]
pub(crate) fn soft_maximum(x: f32) -> f32 {
    x.max(0.0) + 2.0 / (libm::sqrtf(x * x + 4.0) + x.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_exponential_of_every_negative_power() {
        for step in 0..=87_000 {
            let x = step as f32 * 1e-3;
            assert!(
                (f64::from(decay(x)) / (-f64::from(x)).exp() - 1.0).abs() < 3e-7 * (1.0 + f64::from(x) * 0.5),
                "{x}"
            );
        }
        assert_eq!(decay(0.0), 1.0);
        assert!([1e9, f32::INFINITY, f32::NAN].into_iter().all(|x| decay(x) < 1e-37));
    }

    #[test]
    fn the_soft_maximum_is_smooth_at_none_and_the_maximum_far_from_it() {
        for step in -80_000..=80_000 {
            let x = step as f32 * 1e-3;
            let exact = 0.5 * (f64::from(x) + (f64::from(x) * f64::from(x) + 4.0).sqrt());
            assert!((f64::from(soft_maximum(x)) / exact - 1.0).abs() < 1e-5, "{x}");
            assert!(soft_maximum(x) - x.max(0.0) < 1.0 / x.abs().max(1.0) + 1e-5);
        }
        assert_eq!(soft_maximum(1e30), 1e30);
        assert_eq!(soft_maximum(-1e30), 0.0);
    }
}

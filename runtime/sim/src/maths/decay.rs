//! e^(−x), a soft maximum and a smooth step for inner loops: without branches, tables or calls, so the compiler emits
//! vector instructions.
//!
//! All operations are rounded exactly by IEEE 754, so every machine gives the same bits.

use std::f32::consts::{LN_2, LOG2_E};

/// 1.5 · 2²³: a small number added to it leaves its nearest integer in the lowest bits.
const WHOLE: f32 = 12_582_912.0;
/// The least exponent of two that is not denormal.
const POWER_MIN: f32 = -126.0;

/// e^(−x) for x ≥ 0, to 3e−7 of its value; at least 2⁻¹²⁶, which is also the result for NaN.
#[inline]
pub(crate) fn decay(x: f32) -> f32 {
    let power = -x * LOG2_E;
    let power = if power > POWER_MIN { power } else { POWER_MIN };
    let shifted = power + WHOLE;
    let whole_power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(1.0_f32.to_bits()));
    // Within ±½ ln 2 seven terms of Taylor's series suffice.
    let part = (power - (shifted - WHOLE)) * LN_2;
    let terms = [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    whole_power * terms.into_iter().fold(0.0, |sum, term| sum * part + term)
}

/// ½(x + √(x² + 4)), a soft maximum of x and 0: 1 at 0, and elsewhere less than 1/|x| above the maximum.
#[inline]
pub(crate) fn soft_maximum(x: f32) -> f32 {
    x.max(0.0) + 2.0 / (libm::sqrtf(x * x + 4.0) + x.abs())
}

/// 3x² − 2x³, a smooth step from 0 to 1 over [0, 1]; 0 before and 1 after.
#[inline]
pub(crate) fn smooth_step(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decay_matches_the_exponential() {
        for step in 0..=87_000 {
            let x = step as f32 * 1e-3;
            assert!(
                (f64::from(decay(x)) / libm::exp(-f64::from(x)) - 1.0).abs() < 3e-7 * (1.0 + f64::from(x) * 0.5),
                "{x}"
            );
        }
        assert_eq!(decay(0.0), 1.0);
        assert!([1e9, f32::INFINITY, f32::NAN].into_iter().all(|x| decay(x) < 1e-37));
    }

    #[test]
    fn the_soft_maximum_tends_to_the_maximum() {
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

//! When each phase of a cycle comes: a smooth map from phase to time.
//!
//! Phase φ in [0, 1): 0 at right mid-stance, ½ at left mid-stance. The half-strides of real clips are not equal, so
//! with h the share of the period from right to left mid-stance,
//!
//! ```text
//! t(φ) = P·(φ + (h − ½)(1 − cos 2πφ)/2),   dt/dφ = P·(1 + (h − ½)·π·sin 2πφ),
//! ```
//!
//! which meets both landmarks, is periodic and as smooth as can be: the phase rate never jumps, and rises nowhere for
//! |h − ½| < 1/π.

use std::f32::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

/// The greatest |h − ½| accepted: the playback rate then stays within 1/(1 ± 0.63) of its mean. Real clips: 0.1.
pub(crate) const MAX_ASYMMETRY: f32 = 0.2;

/// Phase to time of one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseMap {
    /// P: seconds a cycle (one stride).
    pub period_s: f32,
    /// h: share of the period from right mid-stance (φ = 0) to left mid-stance (φ = ½).
    pub left_share: f32,
}

impl PhaseMap {
    /// Seconds from phase 0; φ may run past 1.
    pub fn time_s(&self, phase: f32) -> f32 {
        self.period_s * (phase + 0.5 * (self.left_share - 0.5) * (1.0 - libm::cosf(TAU * phase)))
    }

    /// dφ/dt, 1/s.
    pub fn rate_hz(&self, phase: f32) -> f32 {
        self.rate_at_hz(Self::sine(phase))
    }

    /// sin 2πφ, which the rates of all cycles at one phase share.
    pub fn sine(phase: f32) -> f32 {
        libm::sinf(TAU * phase)
    }

    /// dφ/dt, 1/s, where sin 2πφ has this value.
    #[inline]
    pub fn rate_at_hz(&self, sine: f32) -> f32 {
        1.0 / (self.period_s * (1.0 + (self.left_share - 0.5) * PI * sine))
    }

    /// The phase in [0, 1) at a time, which may lie in another cycle.
    pub fn phase(&self, time_s: f32) -> f32 {
        let target_s = time_s - self.period_s * libm::floorf(time_s / self.period_s);
        let mut phase = target_s / self.period_s;
        // Newton on a function whose slope is within a factor of 1.63 of its mean: quadratic from the first step.
        for _ in 0..8 {
            phase -= (self.time_s(phase) - target_s) * self.rate_hz(phase);
        }
        wrapped(phase)
    }
}

/// The same phase in [0, 1).
#[inline]
pub fn wrapped(phase: f32) -> f32 {
    let whole = phase as i32 as f32 - if phase < 0.0 { 1.0 } else { 0.0 };
    let wrapped = phase - whole;
    // A little less than none is rounded to a whole cycle.
    if (0.0..1.0).contains(&wrapped) { wrapped } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_inverts_time_and_meets_both_landmarks() {
        for left_share in [0.31, 0.47, 0.5, 0.6, 0.69] {
            let map = PhaseMap { period_s: 1.1, left_share };
            assert!((map.time_s(0.5) - left_share * 1.1).abs() < 1e-6);
            for step in 0..100 {
                let phase = step as f32 / 100.0;
                let back = map.phase(map.time_s(phase) + 1.1);
                let off = (back - phase + 0.5).rem_euclid(1.0) - 0.5;
                assert!(off.abs() < 1e-5, "{left_share} {phase} {back}");
                assert!(map.rate_hz(phase) > 0.0);
            }
        }
    }
}

//! The time of each phase of a cycle: a smooth map from phase to time.
//!
//! Phase φ in [0, 1): 0 at right mid-stance, ½ at left mid-stance. The half-strides of real clips differ. With the
//! period P and the share h of it from right to left mid-stance:
//!
//! ```text
//! t(φ) = P·(φ + (h − ½)(1 − cos 2πφ)/2),   dt/dφ = P·(1 + (h − ½)·π·sin 2πφ)
//! ```
//!
//! The map passes through both landmarks, is periodic and infinitely smooth, so the phase rate never jumps. Time rises
//! with phase for |h − ½| < 1/π.

use std::f32::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

/// Number of uniform phases at which every cycle is stored.
pub const PHASE_COUNT: usize = 64;
/// Greatest |h − ½| that is accepted: the phase rate then stays within 1/(1 ± 0.63) of its mean. Real clips: 0.1.
pub(crate) const MAX_ASYMMETRY: f32 = 0.2;

/// Map from phase to time of one cycle.
///
/// ```
/// use motiondb::PhaseMap;
///
/// // A stride of 1.1 s that reaches left mid-stance after 45 % of it.
/// let map = PhaseMap { period_s: 1.1, left_share: 0.45 };
/// assert!((map.time_s(0.5) - 0.45 * 1.1).abs() < 1e-6);
/// assert!((map.phase(0.45 * 1.1 + 1.1) - 0.5).abs() < 1e-5); // one cycle later
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseMap {
    /// P: duration of a cycle (one stride), seconds.
    pub period_s: f32,
    /// h: share of the period from right mid-stance (φ = 0) to left mid-stance (φ = ½).
    pub left_share: f32,
}

impl PhaseMap {
    /// t(φ): time from phase 0, seconds; φ may exceed 1.
    pub fn time_s(&self, phase: f32) -> f32 {
        self.period_s * (phase + 0.5 * (self.left_share - 0.5) * (1.0 - libm::cosf(TAU * phase)))
    }

    /// Phase rate dφ/dt at a phase, 1/s.
    pub fn rate_hz(&self, phase: f32) -> f32 {
        self.rate_at_hz(Self::sine(phase))
    }

    /// sin 2πφ: the only part of the phase rate that depends on the phase, shared by all cycles.
    pub fn sine(phase: f32) -> f32 {
        libm::sinf(TAU * phase)
    }

    /// Phase rate dφ/dt, 1/s, for a value of [`PhaseMap::sine`].
    #[inline]
    pub fn rate_at_hz(&self, sine: f32) -> f32 {
        1.0 / (self.period_s * (1.0 + (self.left_share - 0.5) * PI * sine))
    }

    /// Phase in [0, 1) at a time, seconds; the time may lie in another cycle.
    pub fn phase(&self, time_s: f32) -> f32 {
        let target_s = time_s - self.period_s * libm::floorf(time_s / self.period_s);
        let mut phase = target_s / self.period_s;
        // Newton's method: the slope stays within a factor of 1.63 of its mean, so it converges from the first step on.
        for _ in 0..8 {
            phase -= (self.time_s(phase) - target_s) * self.rate_hz(phase);
        }
        wrapped(phase)
    }
}

/// The phase reduced to [0, 1).
#[inline]
pub fn wrapped(phase: f32) -> f32 {
    let whole = phase as i32 as f32 - if phase < 0.0 { 1.0 } else { 0.0 };
    let wrapped = phase - whole;
    // A phase slightly below 0 rounds up to 1.
    if (0.0..1.0).contains(&wrapped) { wrapped } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_inverts_time_and_passes_both_landmarks() {
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

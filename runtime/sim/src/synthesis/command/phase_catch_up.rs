//! Phase catch-up: the phase runs faster or slower than its own rate, so that it catches up with the planted feet.
//!
//! When a body speeds up within a step, its planted foot is further back than the faster steps have it at this phase.
//! The phase then runs faster, and the foot meets the pose again before the leg must stretch; when the body slows down,
//! the reverse. c is the shift of a planted foot against the pose's, u the velocity at which the root carries a foot.
//! The feet lag by the time that explains both shifts best,
//!
//! ```text
//! t = −Σ c·u / Σ u²,
//! ```
//!
//! in which the foot that moves further in a turn weighs more. Only the part of t beyond its usual value counts.
//! Examples with sliding feet shift every foot a little, step by step; without the usual value the phase would run fast
//! forever.
//!
//! World frame; metres, seconds.

use glam::Vec2;

use crate::synthesis::TimeStep;
use crate::synthesis::pose::FootLock;

/// Time in which the phase catches up with a planted foot, s: about half a stance.
const CATCH_UP_TIME_S: f32 = 0.2;
/// Greatest change of the phase rate, divided by the rate itself.
const RATE_CHANGE_MAX: f32 = 0.4;
/// Least speed u that counts, m/s: a slower foot hardly moves with its phase.
const SPEED_MIN_MPS: f32 = 0.4;

/// Phase catch-up of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PhaseCatchUp {
    /// Usual lag of the feet behind the root, s.
    usual_lag_s: f32,
}

impl PhaseCatchUp {
    /// Factor on the phase rate. `carried_mps` gives the velocity at which the root carries a foot, m/s.
    pub(crate) fn follow(
        &mut self,
        feet: &[FootLock; 2],
        carried_mps: impl Fn(&FootLock) -> Vec2,
        step: &TimeStep,
    ) -> f32 {
        let lag_max_s = RATE_CHANGE_MAX * CATCH_UP_TIME_S;
        let lag_s = lag_s(feet, carried_mps);
        let unusual_s = (lag_s - self.usual_lag_s).clamp(-lag_max_s, lag_max_s);
        let limited_s = lag_s.clamp(-lag_max_s, lag_max_s);
        self.usual_lag_s = limited_s + step.usual_lag_left * (self.usual_lag_s - limited_s);
        1.0 + unusual_s / CATCH_UP_TIME_S
    }
}

/// t, s.
fn lag_s(feet: &[FootLock; 2], carried_mps: impl Fn(&FootLock) -> Vec2) -> f32 {
    let (mut back, mut square) = (0.0, 0.0);
    for foot in feet {
        let Some(shift_m) = foot.planted_shift_m() else { continue };
        let carried_mps = carried_mps(foot);
        back -= shift_m.dot(carried_mps);
        square += carried_mps.length_squared().max(SPEED_MIN_MPS * SPEED_MIN_MPS);
    }
    back / square.max(SPEED_MIN_MPS * SPEED_MIN_MPS)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::synthesis::pose::foot_lock::{Footing, PosedFoot};

    /// Factors on the phase rate, step by step, where the planted feet of the pose slide back at `slide_mps`.
    fn factors(slide_mps: f32, seconds: f32) -> Vec<f32> {
        let step = TimeStep::new(1.0 / 60.0);
        let posed = |time_s: f32| PosedFoot {
            ankle_m: Vec3::new(-slide_mps * time_s, 0.0, 0.07),
            sole_m: [-0.05, 0.13, 0.2].map(|along_m| Vec3::new(along_m - slide_mps * time_s, 0.0, 0.0)),
        };
        let (mut catch_up, mut feet) = (PhaseCatchUp::default(), [FootLock::new(&posed(0.0)); 2]);
        let footing = Footing { planted: true, contact_ahead: 1.0, ..Footing::default() };
        let mut factor = |index: usize| {
            // Each half second a new stance begins.
            let since = index % 30;
            let time_s = since as f32 * step.dt_s;
            feet.iter_mut().for_each(|foot| {
                if since == 0 {
                    *foot = FootLock::new(&posed(time_s));
                }
                let locked = foot.step(&posed(time_s), &footing, &step);
                let moved_m = locked.ankle_m - posed(time_s).ankle_m;
                foot.record_drawn(posed(time_s).sole_m.map(|point_m| point_m + moved_m), &step);
            });
            catch_up.follow(&feet, |_| Vec2::X, &step)
        };
        (0..(seconds / step.dt_s) as usize).map(&mut factor).collect()
    }

    #[test]
    fn the_phase_slows_down_for_leading_feet() {
        let factors = factors(0.2, 12.0);
        let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len() as f32;
        assert!(mean(&factors[..30]) < 0.9, "{}", mean(&factors[..30]));
        assert!((mean(&factors[600..]) - 1.0).abs() < 0.01, "{}", mean(&factors[600..]));
    }
}

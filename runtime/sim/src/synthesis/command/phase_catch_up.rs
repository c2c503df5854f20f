//! How much faster than its own time a body plays, so that its phase catches up with its planted feet.
//!
//! A body that speeds up within a step has its foot further back than the faster steps have it at this phase: the phase
//! hurries, and the foot meets the pose again before the leg must stretch; likewise when it slows down. With c the
//! shift of a planted foot against the pose's, and u the velocity at which the root would carry it along, feet are
//! behind by the time that explains both shifts best,
//!
//! ```text
//! t = −Σ c·u / Σ u²,
//! ```
//!
//! so that in a turn the foot that goes further counts for more.
//!
//! But examples whose feet slip as they stand leave every foot behind a little, step by step: what a body is used to is
//! no reason to hurry, or it would play all its life faster than its root goes.
//!
//! World, metres, seconds.

use glam::Vec2;

use crate::synthesis::pose::foot_lock::FootHold;
use crate::synthesis::time_step::TimeStep;

/// Time in which the phase catches up with a planted foot, s: about half a stance.
const CATCH_UP_TIME_S: f32 = 0.2;
/// Greatest change of the phase rate for it.
const HURRY_MAX: f32 = 0.4;
/// A foot that is carried slower than this hardly moves by its phase, m/s.
const SPEED_MIN_MPS: f32 = 0.4;
/// A body gets used to how far its feet are behind in this time, s: a stride at 100 steps a minute, an adult's walk.
pub(crate) const HABIT_TIME_S: f32 = 1.2;

/// What a body is used to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hurry {
    /// Time by which the root is mostly ahead of the feet, s.
    habit_s: f32,
}

impl Hurry {
    /// Factor on the phase rate of a body whose root would carry a foot along at `carried_mps`, world, m/s.
    pub fn follow(&mut self, feet: &[FootHold; 2], carried_mps: impl Fn(&FootHold) -> Vec2, step: &TimeStep) -> f32 {
        let behind_max_s = HURRY_MAX * CATCH_UP_TIME_S;
        let behind_s = behind_s(feet, carried_mps);
        let unused_s = (behind_s - self.habit_s).clamp(-behind_max_s, behind_max_s);
        let usual_s = behind_s.clamp(-behind_max_s, behind_max_s);
        self.habit_s = usual_s + step.habit * (self.habit_s - usual_s);
        1.0 + unused_s / CATCH_UP_TIME_S
    }
}

/// t: for how long the planted feet would have to be carried back to be where the pose has them, s.
fn behind_s(feet: &[FootHold; 2], carried_mps: impl Fn(&FootHold) -> Vec2) -> f32 {
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
    use crate::synthesis::pose::foot_lock::PosedFoot;

    /// Factors on the phase rate, step by step, where the pose's planted feet slip back by a length in each second.
    fn factors(slip_mps: f32, seconds: f32) -> Vec<f32> {
        let step = TimeStep::new(1.0 / 60.0);
        let posed = |time_s: f32| PosedFoot {
            ankle_m: Vec3::new(-slip_mps * time_s, 0.0, 0.07),
            sole_m: [-0.05, 0.13, 0.2].map(|along_m| Vec3::new(along_m - slip_mps * time_s, 0.0, 0.0)),
        };
        let (mut hurry, mut feet) = (Hurry::default(), [FootHold::new(&posed(0.0)); 2]);
        let mut factor = |index: usize| {
            // Each stance of half a second begins anew.
            let since = index % 30;
            let time_s = since as f32 * step.dt_s;
            feet.iter_mut().for_each(|foot| {
                if since == 0 {
                    *foot = FootHold::new(&posed(time_s));
                }
                let held = foot.step(&posed(time_s), true, 1.0, &step);
                let moved_m = held.ankle_m - posed(time_s).ankle_m;
                foot.placed(posed(time_s).sole_m.map(|point_m| point_m + moved_m), &step);
            });
            hurry.follow(&feet, |_| Vec2::X, &step)
        };
        (0..(seconds / step.dt_s) as usize).map(&mut factor).collect()
    }

    #[test]
    fn a_body_whose_feet_are_ahead_of_its_pose_slows_down_and_gets_used_to_it() {
        let factors = factors(0.2, 12.0);
        let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len() as f32;
        assert!(mean(&factors[..30]) < 0.9, "{}", mean(&factors[..30]));
        assert!((mean(&factors[600..]) - 1.0).abs() < 0.01, "{}", mean(&factors[600..]));
    }
}

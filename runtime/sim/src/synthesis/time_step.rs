//! One step of time, and what it leaves of all that decays: computed once for all bodies.
//!
//! With r a rate, a critically damped spring `x'' = −2r·x' − r²·x` takes an offset x and its rate v, exactly over a
//! step, to
//!
//! ```text
//! x' = e^(−r·dt)·(x + dt·(v + r·x)),   v' = e^(−r·dt)·(v − r·dt·(v + r·x)).
//! ```

use std::ops::{Add, Mul, Sub};

use crate::synthesis::command::{command_filter, displacement_accumulator, phase_catch_up};
use crate::synthesis::hybrid::{inertialization, pose_smoothing};
use crate::synthesis::pose::{foot_lock, look_at, pelvis};

/// The length of a step, and its decays.
#[derive(Clone, Copy, Debug)]
pub struct TimeStep {
    /// dt, seconds.
    pub dt_s: f32,
    /// The moment before its end by which motion is told from poses, s.
    pub(crate) look_back_s: f32,
    /// What is left of a debt.
    pub(crate) owed: f32,
    /// What is left of how steadily plans changed before.
    pub(crate) steady: f32,
    /// What is left of what was seen before.
    pub(crate) seen: f32,
    /// What is left of what a body was used to.
    pub(crate) habit: f32,
    pub(crate) turn_about: Spring,
    pub(crate) gaze: Spring,
    pub(crate) inertia: Spring,
    pub(crate) release: SoftSpring,
    pub(crate) lift: SoftSpring,
    pub(crate) rise: SoftSpring,
    /// What is left of landing after a step, and after half of one.
    pub(crate) landing: [f32; 2],
    /// What is left of how fast a foot moved before.
    pub(crate) foot_speed: f32,
}

impl TimeStep {
    /// Of `dt_s` seconds.
    pub fn new(dt_s: f32) -> Self {
        let left = |time_s: f32| libm::expf(-dt_s / time_s);
        let spring = |rate_hz: f32| Spring { decay: libm::expf(-rate_hz * dt_s), rate_hz, dt_s };
        let soft_spring = |rate_hz: f32| SoftSpring(spring(rate_hz));
        Self {
            dt_s,
            look_back_s: inertialization::LOOK_BACK_S.min(dt_s),
            owed: left(displacement_accumulator::FORGETTING_TIME_S),
            steady: left(command_filter::STEADY_S),
            seen: left(pose_smoothing::EASE_TIME_S),
            habit: left(phase_catch_up::HABIT_TIME_S),
            turn_about: spring(pose_smoothing::TURN_ABOUT_RATE_HZ),
            gaze: spring(look_at::RATE_HZ),
            inertia: spring(inertialization::RATE_HZ),
            release: soft_spring(foot_lock::RELEASE_RATE_HZ),
            lift: soft_spring(foot_lock::LIFT_RATE_HZ),
            rise: soft_spring(pelvis::RISE_RATE_HZ),
            landing: [foot_lock::LANDING_TIME_S, 2.0 * foot_lock::LANDING_TIME_S].map(left),
            foot_speed: left(foot_lock::SPEED_TIME_S),
        }
    }
}

/// A critically damped spring over one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    decay: f32,
    rate_hz: f32,
    dt_s: f32,
}

impl Spring {
    /// What is left of an offset and of its rate, a second.
    pub(crate) fn pass<T>(&self, offset: T, rate: T) -> (T, T)
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
    {
        let pull = rate + offset * self.rate_hz;
        let passed = pull * self.dt_s;
        ((offset + passed) * self.decay, (rate - passed * self.rate_hz) * self.decay)
    }
}

/// A critically damped filter of the third order over one step: it lets go gently, where a spring pulls with r²·x at
/// once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SoftSpring(Spring);

impl SoftSpring {
    /// What is left of an offset, of its rate and of the rate of that, a second.
    pub(crate) fn pass<T>(&self, [offset, rate, acceleration]: [T; 3]) -> [T; 3]
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
    {
        // (c₀ + c₁t + ½c₂t²)·e^(−r·t) and its derivatives.
        let Spring { decay, rate_hz, dt_s } = self.0;
        let c1 = rate + offset * rate_hz;
        let c2 = acceleration + (rate + c1) * rate_hz;
        let slope = c1 + c2 * dt_s;
        let passed = offset + (c1 + slope) * (0.5 * dt_s);
        let steeper = slope - passed * rate_hz;
        [passed * decay, steeper * decay, (c2 - (slope + steeper) * rate_hz) * decay]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OFFSETS: [f32; 3] = [0.4, -3.0, 5.0];

    fn soft(rate_hz: f32, dt_s: f32) -> SoftSpring {
        SoftSpring(Spring { decay: libm::expf(-rate_hz * dt_s), rate_hz, dt_s })
    }

    #[test]
    fn one_step_of_a_soft_spring_is_as_good_as_many() {
        let one = soft(12.0, 0.1).pass(OFFSETS);
        let many = (0..20).fold(OFFSETS, |offsets, _| soft(12.0, 0.005).pass(offsets));
        assert!(
            one.iter().zip(many).all(|(one, many)| (one - many).abs() < 1e-4 * (1.0 + many.abs())),
            "{one:?} {many:?}"
        );
    }

    #[test]
    fn a_soft_spring_lets_go_at_the_rates_that_there_were() {
        let dt_s = 1e-3;
        let [offset, rate, acceleration] = soft(12.0, dt_s).pass(OFFSETS);
        assert!((offset - (OFFSETS[0] + dt_s * OFFSETS[1] + 0.5 * dt_s * dt_s * OFFSETS[2])).abs() < 1e-6);
        assert!((rate - (OFFSETS[1] + dt_s * OFFSETS[2])).abs() < 2e-3 && (acceleration - OFFSETS[2]).abs() < 2.0);
    }

    #[test]
    fn one_step_of_a_spring_is_as_good_as_many() {
        let rate_hz = 12.0;
        let passed = |steps: usize| {
            let spring = Spring { decay: libm::expf(-rate_hz * 0.1 / steps as f32), rate_hz, dt_s: 0.1 / steps as f32 };
            (0..steps).fold((0.4, -3.0), |(offset, rate), _| spring.pass(offset, rate))
        };
        let ((one, one_rate), (many, many_rate)) = (passed(1), passed(50));
        assert!((one - many).abs() < 1e-5 && (one_rate - many_rate).abs() < 1e-4);
    }
}

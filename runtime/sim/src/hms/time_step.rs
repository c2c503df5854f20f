//! One step of time, and what it leaves of all that decays: computed once for all bodies.
//!
//! With r a rate, a critically damped spring `x'' = −2r·x' − r²·x` takes an offset x and its rate v, exactly over a
//! step, to
//!
//! ```text
//! x' = e^(−r·dt)·(x + dt·(v + r·x)),   v' = e^(−r·dt)·(v − r·dt·(v + r·x)).
//! ```

use std::ops::{Add, Mul, Sub};

use super::{feet, gaze, hurry, inertialization, intention, owed, pelvis, seen};

/// The length of a step, and its decays.
#[derive(Clone, Copy, Debug)]
pub struct TimeStep {
    /// dt, seconds.
    pub dt_s: f32,
    /// The moment before its end by which motion is told from poses, s.
    pub(super) look_back_s: f32,
    /// What is left of a debt.
    pub(super) owed: f32,
    /// What is left of how steadily plans changed before.
    pub(super) steady: f32,
    /// What is left of what was seen before.
    pub(super) seen: f32,
    /// What is left of what a body was used to.
    pub(super) habit: f32,
    pub(super) turn_about: Spring,
    pub(super) gaze: Spring,
    pub(super) inertia: Spring,
    pub(super) release: SoftSpring,
    pub(super) lift: SoftSpring,
    pub(super) rise: SoftSpring,
    /// What is left of landing after a step, and after half of one.
    pub(super) landing: [f32; 2],
    /// What is left of how fast a foot moved before.
    pub(super) foot_speed: f32,
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
            owed: left(owed::FORGETTING_TIME_S),
            steady: left(intention::STEADY_S),
            seen: left(seen::EASE_TIME_S),
            habit: left(hurry::HABIT_TIME_S),
            turn_about: spring(seen::TURN_ABOUT_RATE_HZ),
            gaze: spring(gaze::RATE_HZ),
            inertia: spring(inertialization::RATE_HZ),
            release: soft_spring(feet::RELEASE_RATE_HZ),
            lift: soft_spring(feet::LIFT_RATE_HZ),
            rise: soft_spring(pelvis::RISE_RATE_HZ),
            landing: [feet::LANDING_TIME_S, 2.0 * feet::LANDING_TIME_S].map(left),
            foot_speed: left(feet::SPEED_TIME_S),
        }
    }
}

/// A critically damped spring over one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    decay: f32,
    rate_hz: f32,
    dt_s: f32,
}

impl Spring {
    /// What is left of an offset and of its rate, a second.
    pub(super) fn pass<T>(&self, offset: T, rate: T) -> (T, T)
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
pub(super) struct SoftSpring(Spring);

impl SoftSpring {
    /// What is left of an offset, of its rate and of the rate of that, a second.
    pub(super) fn pass<T>(&self, [offset, rate, acceleration]: [T; 3]) -> [T; 3]
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

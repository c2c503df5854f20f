//! Decay factors of one time step, computed once and shared by all bodies.
//!
//! A quantity with time constant T keeps the share e^(−dt/T) over a step. A critically damped spring of rate r takes an
//! offset x and its rate of change v exactly to x' and v':
//!
//! ```text
//! d²x/dt² = −2r·dx/dt − r²·x
//! x' = e^(−r·dt)·(x + dt·(v + r·x)),   v' = e^(−r·dt)·(v − r·dt·(v + r·x)).
//! ```
//!
//! The constants below are all time constants (s) and rates (1/s) of the synthesis. Each doc names the file that uses
//! the constant; `docs/tuning.md` holds the measurements behind them.

use std::ops::{Add, Mul, Sub};

/// Time constant with which saved displacement is forgotten (`displacement_accumulator`), s. A plan slower than 5 cm/s
/// never adds up to a step.
const DISPLACEMENT_TIME_S: f32 = 4.0;
/// T_r, time constant of the steady rate of change of commands (`command_filter`), s. It is longer than two steps of
/// 0.1 s, over which plans alternate.
const COMMAND_RATE_TIME_S: f32 = 0.15;
/// Time constant of pose smoothing (`pose_smoothing`), s: a fifth of the duration of the fastest change of speed.
const SMOOTHING_TIME_S: f32 = 0.05;
/// Time constant with which the usual lag of the feet is learnt (`phase_catch_up`), s: an adult's stride at 100 steps a
/// minute.
const USUAL_LAG_TIME_S: f32 = 1.2;
/// Time constant with which the pace of a slow step changes (`step_timing`), s: legs do not jerk.
const PACE_TIME_S: f32 = 0.03;
/// Time constant with which a lead decays that steps do not make up (`step_timing`), s: slower than a weight shift.
const LEAD_TIME_S: f32 = 0.5;
/// Rate of the spring that turns the direction of travel about (`pose_smoothing`), 1/s: the legs reverse in one step.
const TRAVEL_RATE_HZ: f32 = 10.0;
/// Rate of the spring that turns head and chest (`look_at`), 1/s. From straight ahead to the greatest angle the head
/// then turns at 200 °/s, as in a glance.
const LOOK_AT_RATE_HZ: f32 = 12.0;
/// Rate of the filter by which the trunk leans with an acceleration (`excess_lean`), 1/s: it lags by 0.1 s.
const LEAN_RATE_HZ: f32 = 30.0;
/// Rate of the filter by which the whole body leans in a curve (`excess_lean`), 1/s: four fifths of the lean are made in
/// 0.45 s, a step, since the feet land outward.
const BODY_LEAN_RATE_HZ: f32 = 10.0;
/// Rate of the filter that moves the pelvis of a standing body over its feet (`centring`), 1/s: 6 cm at .025 m/s at most.
const CENTRING_RATE_HZ: f32 = 1.5;
/// Rate of the filter that shifts the weight before a first step (`weight_shift`), 1/s: within 0.3 s the pelvis makes
/// four fifths of the shift.
const WEIGHT_SHIFT_RATE_HZ: f32 = 15.0;
/// Rate of the filter that turns the shoulders where room is narrow (`squeeze`), 1/s: four fifths of the turn are made in
/// 0.45 s, in which a walking body passes the strip of half a metre ahead.
const SQUEEZE_RATE_HZ: f32 = 10.0;
/// Rate of the filter by which the upper body keeps clear of walls and bodies (`body_clearance`), 1/s: it lags by 0.1 s.
const CLEARANCE_RATE_HZ: f32 = 30.0;
/// Rate of the filter that removes a jump of the phase (`secondary_motion`), 1/s: too slow to show within a stride.
const SECONDARY_RATE_HZ: f32 = 4.0;
/// Rate of the spring that removes the difference of poses after a switch (`inertialization`), 1/s. A switch happens at
/// mid-stance: 14 % is left when the next foot lands (0.3 s), 5 % after a step (0.4 s).
const INERTIA_RATE_HZ: f32 = 12.0;
/// Time after which the difference of poses at a switch has decayed (`hybrid_data`), s: 5 % is left.
pub const INERTIA_DURATION_S: f32 = 0.4;
/// Interval over which the rate of a pose difference is taken (`inertialization`), s; a shorter step replaces it.
const LOOK_BACK_S: f32 = 1.0 / 120.0;
/// Rate of the filter that releases a foot lock (`foot_lock`), 1/s: 2 % is left after 0.25 s, before the foot lands.
const LOCK_RELEASE_RATE_HZ: f32 = 30.0;
/// Rate of the filter that moves a foot in a settling step (`foot_lock`), 1/s: 3 % of the way is left when it lands.
const SETTLING_RATE_HZ: f32 = 16.0;
/// Rate of the filter that lowers a planted sole to the ground and lifts a swinging one (`foot_lock`), 1/s.
const FOOT_LIFT_RATE_HZ: f32 = 80.0;
/// Time constant with which a foot that lands while it still moves comes to rest (`foot_lock`), s. It is well within
/// the tenth of a stance in which the sole rolls down; at once would jerk the knee.
pub(crate) const LANDING_TIME_S: f32 = 0.012;
/// Time constant of the mean speed of a foot (`foot_lock`), s: the speed jumps at each row of the database.
const FOOT_SPEED_TIME_S: f32 = 0.03;

/// The length of a step and its decay factors. "Share left" is the share of a value that is left after the step.
#[derive(Clone, Copy, Debug)]
pub struct TimeStep {
    /// Length of the step dt, s.
    pub dt_s: f32,
    /// Interval before the end of the step over which the rates of poses are taken, s.
    pub(crate) look_back_s: f32,
    /// Share left of accumulated displacement.
    pub(crate) displacement_left: f32,
    /// Share left of the steady rate of change of commands.
    pub(crate) command_rate_left: f32,
    /// Share left of the distance between smoothed and current motion.
    pub(crate) smoothing_left: f32,
    /// Share left of the usual lag of the feet.
    pub(crate) usual_lag_left: f32,
    /// Share left of the earlier pace of steps.
    pub(crate) pace_left: f32,
    /// Share left of a lead that steps do not make up.
    pub(crate) lead_left: f32,
    /// Spring of the direction of travel.
    pub(crate) travel: Spring,
    /// Spring of the look-at angle.
    pub(crate) look_at: Spring,
    /// Filter of the trunk's lean.
    pub(crate) lean: SoftSpring,
    /// Filter of the lean of the whole body.
    pub(crate) body_lean: SoftSpring,
    /// Filter of the turn of the shoulders.
    pub(crate) squeeze: SoftSpring,
    /// Filter of the turns that keep the upper body clear.
    pub(crate) clearance: SoftSpring,
    /// Filter of the phase of secondary motion.
    pub(crate) secondary: SoftSpring,
    /// Filter of the weight shift.
    pub(crate) weight_shift: SoftSpring,
    /// Filter that moves the pelvis of a standing body over its feet.
    pub(crate) centring: SoftSpring,
    /// Spring of the pose difference after a switch.
    pub(crate) inertia: Spring,
    /// Filter that releases a foot lock.
    pub(crate) lock_release: SoftSpring,
    /// Filter of a settling step.
    pub(crate) settling: SoftSpring,
    /// Filter of the lift of a foot.
    pub(crate) foot_lift: SoftSpring,
    /// Shares left of the speed of a landing foot: after the step, and after half of it.
    pub(crate) landing_left: [f32; 2],
    /// Share left of the earlier mean speed of a foot.
    pub(crate) foot_speed_left: f32,
}

impl TimeStep {
    /// The decay factors of a step of `dt_s` seconds.
    pub fn new(dt_s: f32) -> Self {
        let left = |time_s: f32| libm::expf(-dt_s / time_s);
        let spring = |rate_hz: f32| Spring { decay: libm::expf(-rate_hz * dt_s), rate_hz, dt_s };
        let soft_spring = |rate_hz: f32| SoftSpring(spring(rate_hz));
        Self {
            dt_s,
            look_back_s: LOOK_BACK_S.min(dt_s),
            displacement_left: left(DISPLACEMENT_TIME_S),
            command_rate_left: left(COMMAND_RATE_TIME_S),
            smoothing_left: left(SMOOTHING_TIME_S),
            usual_lag_left: left(USUAL_LAG_TIME_S),
            pace_left: left(PACE_TIME_S),
            lead_left: left(LEAD_TIME_S),
            travel: spring(TRAVEL_RATE_HZ),
            look_at: spring(LOOK_AT_RATE_HZ),
            lean: soft_spring(LEAN_RATE_HZ),
            body_lean: soft_spring(BODY_LEAN_RATE_HZ),
            squeeze: soft_spring(SQUEEZE_RATE_HZ),
            clearance: soft_spring(CLEARANCE_RATE_HZ),
            secondary: soft_spring(SECONDARY_RATE_HZ),
            weight_shift: soft_spring(WEIGHT_SHIFT_RATE_HZ),
            centring: soft_spring(CENTRING_RATE_HZ),
            inertia: spring(INERTIA_RATE_HZ),
            lock_release: soft_spring(LOCK_RELEASE_RATE_HZ),
            settling: soft_spring(SETTLING_RATE_HZ),
            foot_lift: soft_spring(FOOT_LIFT_RATE_HZ),
            landing_left: [LANDING_TIME_S, 2.0 * LANDING_TIME_S].map(left),
            foot_speed_left: left(FOOT_SPEED_TIME_S),
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
    /// Offset and rate of change (per second) after the step.
    pub(crate) fn decayed<T>(&self, offset: T, rate: T) -> (T, T)
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
    {
        let slope = rate + offset * self.rate_hz;
        let change = slope * self.dt_s;
        ((offset + change) * self.decay, (rate - change * self.rate_hz) * self.decay)
    }
}

/// A critically damped filter of the third order over one step. Its acceleration starts at its present value; that of a
/// spring jumps to −r²·x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SoftSpring(Spring);

impl SoftSpring {
    /// Moves a value, with its rate of change and acceleration, toward a target that rests.
    pub(crate) fn approach<T>(&self, [value, rate, acceleration]: &mut [T; 3], target: T)
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
    {
        let [offset, new_rate, new_acceleration] = self.decayed([*value - target, *rate, *acceleration]);
        (*value, *rate, *acceleration) = (target + offset, new_rate, new_acceleration);
    }

    /// Offset, rate of change (per second) and acceleration (per second²) after the step.
    pub(crate) fn decayed<T>(&self, [offset, rate, acceleration]: [T; 3]) -> [T; 3]
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
    {
        // x(t) = (c₀ + c₁·t + ½c₂·t²)·e^(−r·t), and its derivatives.
        let Spring { decay, rate_hz, dt_s } = self.0;
        let c1 = rate + offset * rate_hz;
        let c2 = acceleration + (rate + c1) * rate_hz;
        let slope = c1 + c2 * dt_s;
        let value = offset + (c1 + slope) * (0.5 * dt_s);
        let value_rate = slope - value * rate_hz;
        [value * decay, value_rate * decay, (c2 - (slope + value_rate) * rate_hz) * decay]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OFFSETS: [f32; 3] = [0.4, -3.0, 5.0];

    fn soft_spring(rate_hz: f32, dt_s: f32) -> SoftSpring {
        SoftSpring(Spring { decay: libm::expf(-rate_hz * dt_s), rate_hz, dt_s })
    }

    #[test]
    fn one_step_of_a_soft_spring_equals_many() {
        let one = soft_spring(12.0, 0.1).decayed(OFFSETS);
        let many = (0..20).fold(OFFSETS, |offsets, _| soft_spring(12.0, 0.005).decayed(offsets));
        assert!(
            one.iter().zip(many).all(|(one, many)| (one - many).abs() < 1e-4 * (1.0 + many.abs())),
            "{one:?} {many:?}"
        );
    }

    #[test]
    fn a_soft_spring_starts_at_the_given_rates() {
        let dt_s = 1e-3;
        let [offset, rate, acceleration] = soft_spring(12.0, dt_s).decayed(OFFSETS);
        assert!((offset - (OFFSETS[0] + dt_s * OFFSETS[1] + 0.5 * dt_s * dt_s * OFFSETS[2])).abs() < 1e-6);
        assert!((rate - (OFFSETS[1] + dt_s * OFFSETS[2])).abs() < 2e-3 && (acceleration - OFFSETS[2]).abs() < 2.0);
    }

    #[test]
    fn one_step_of_a_spring_equals_many() {
        let rate_hz = 12.0;
        let after = |steps: usize| {
            let spring = Spring { decay: libm::expf(-rate_hz * 0.1 / steps as f32), rate_hz, dt_s: 0.1 / steps as f32 };
            (0..steps).fold((0.4, -3.0), |(offset, rate), _| spring.decayed(offset, rate))
        };
        let ((one, one_rate), (many, many_rate)) = (after(1), after(50));
        assert!((one - many).abs() < 1e-5 && (one_rate - many_rate).abs() < 1e-4);
    }
}

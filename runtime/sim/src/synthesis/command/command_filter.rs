//! What a body means to do: what its plans ask for, without their trembling.
//!
//! Two who give way to each other change their plans at every step, and a body that followed at once would tremble; one
//! that always lagged would fall behind a plan that really changes. So the lag depends on how steadily the plans change
//! (the "1 € filter": Casiez, Roussel, Vogel 2012). With x what is asked and y what is intended, per axis of (v_f, ω_t,
//! ω_s), m/s and rad/s,
//!
//! ```text
//! r' = (x' − r)/T_r,   y' = (x − y)/τ,   τ = τ_0/(1 + |r|/r_0).
//! ```
//!
//! A plan is made for a whole step: it leads, by half of it. In fine steps it is led by as much as in coarser ones,
//! along r where it still changes so, and a body lags hardly more behind many small steps than behind a few.

use glam::{Vec2, Vec3};
use motiondb::motion::Parameters;

use crate::maths::angle::direction;
use crate::maths::decay::decay;
use crate::synthesis::time_step::TimeStep;

/// τ_0: lag behind plans that change to and fro, s.
const LAG_S: f32 = 0.15;
/// r_0: the lag halves at this steady change, m/s² and rad/s².
const RATE: f32 = 1.0;
/// T_r: a change that lasts this long is steady, s: longer than two steps of 0.1 s, in which plans go to and fro.
pub(crate) const STEADY_S: f32 = 0.15;
/// The step by half of which plans lead at least, s. Those of 0.1 s lead by more; with as much in finer ones, bodies
/// that give way to each other accelerate more than they need.
const LEAD_STEP_S: f32 = 0.05;
/// A change from one step to the next counts for no more than this, m/s² and rad/s²: what a body can follow.
const CHANGE_MAX: f32 = 3.0;

/// Follows what is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Intention {
    /// y.
    pub parameters: Parameters,
    /// x of the last step.
    asked: Vec3,
    /// r.
    rate: Vec3,
    /// x' of the last step, no more than can be followed.
    change: Vec3,
}

impl Intention {
    /// Takes up what is asked now. A body that stands does not tremble: it needs no lag.
    pub fn follow(&mut self, asked: Parameters, stands: bool, step: &TimeStep) {
        let asked = asked.to_vec3();
        let change = (asked - self.asked) / step.dt_s;
        self.rate += (1.0 - step.steady) * (change - self.rate);
        (self.asked, self.change) = (asked, change.clamp_length_max(CHANGE_MAX));
        let lags = step.dt_s / LAG_S * (1.0 + self.rate.length() / RATE);
        let share = if stands { 1.0 } else { 1.0 - decay(lags) };
        let intended = self.parameters.to_vec3();
        let led = asked + 0.5 * (LEAD_STEP_S - step.dt_s).max(0.0) * self.steady_rate();
        self.parameters = Parameters::from_vec3(intended + share * (led - intended));
    }

    /// What will be intended after a time, if it goes on to change as what is asked does.
    pub fn ahead(&self, time_s: f32) -> Parameters {
        Parameters::from_vec3(self.parameters.to_vec3() + time_s * self.steady_rate())
    }

    /// How what is asked changes, and has been changing: none on the axes on which it has just jumped, or rests.
    fn steady_rate(&self) -> Vec3 {
        let alike = (self.rate * self.change).cmpgt(Vec3::ZERO);
        Vec3::select(alike, self.rate.signum() * self.rate.abs().min(self.change.abs()), Vec3::ZERO)
    }

    /// The facing has turned under velocities that are meant in the world.
    pub fn turned(&mut self, by_rad: f32) {
        let back = direction(-by_rad);
        let turned = |vector: Vec3| {
            let velocity = back.rotate(Vec2::new(vector.x, vector.z));
            Vec3::new(velocity.x, vector.y, velocity.y)
        };
        self.parameters = Parameters::from_vec3(turned(self.parameters.to_vec3()));
        [self.asked, self.rate, self.change] = [self.asked, self.rate, self.change].map(turned);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speeds intended, where these are asked step by step.
    fn intended_mps(dt_s: f32, asked_mps: impl Iterator<Item = f32>) -> Vec<f32> {
        let mut intention = Intention::default();
        let follow = |speed_mps| {
            intention.follow(Parameters { speed_mps, ..Parameters::default() }, false, &TimeStep::new(dt_s));
            intention.parameters.speed_mps
        };
        asked_mps.map(follow).collect()
    }

    #[test]
    fn plans_that_go_to_and_fro_are_calmed() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let speeds_mps = intended_mps(dt_s, (0..200).map(|step| if step % 2 == 0 { 1.2 } else { 1.0 }));
            let swing_mps = (speeds_mps[199] - speeds_mps[198]).abs();
            assert!(swing_mps < 0.13, "dt {dt_s}: {swing_mps} m/s of 0.2");
        }
    }

    /// How far an intention falls behind a plan that speeds up by 2.5 m/s² to 1 m/s.
    fn behind_m(dt_s: f32) -> f32 {
        let speed_mps = |step: usize| (2.5 * step as f32 * dt_s).min(1.0);
        let steps = (2.0 / dt_s) as usize;
        let intended_mps = intended_mps(dt_s, (0..steps).map(speed_mps));
        (0..steps).map(|step| dt_s * (speed_mps(step) - intended_mps[step])).sum()
    }

    #[test]
    fn a_plan_that_changes_steadily_is_followed_closely() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            assert!(behind_m(dt_s) < 0.06, "dt {dt_s}: {} m", behind_m(dt_s));
        }
    }

    #[test]
    fn many_small_steps_lag_hardly_more_than_a_few() {
        let [fine_m, films_m] = [1.0 / 240.0, 1.0 / 30.0].map(behind_m);
        assert!(fine_m < 1.15 * films_m, "{fine_m} m, {films_m} m");
    }

    #[test]
    fn a_velocity_that_rests_in_the_world_needs_no_following_in_a_turn() {
        let mut intention = Intention::default();
        let asked = |facing_rad: f32| Parameters {
            speed_mps: libm::cosf(facing_rad),
            turn_rate_rad_s: 0.0,
            strafe_mps: -libm::sinf(facing_rad),
        };
        intention.follow(asked(0.0), true, &TimeStep::new(0.1));
        for step in 1..20 {
            intention.turned(0.1);
            let asked = asked(0.1 * step as f32);
            intention.follow(asked, false, &TimeStep::new(0.1));
            assert!((intention.parameters.to_vec3() - asked.to_vec3()).length() < 1e-4);
        }
    }
}

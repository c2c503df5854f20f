//! Command filter: the command of a body, filtered over time from what its plans request.
//!
//! Two agents that avoid each other change their plans at every step. A body that followed at once would tremble; one
//! with a constant lag would fall behind a plan that really changes. So the lag depends on how steadily the requests
//! change (the "1 € filter": Casiez, Roussel, Vogel 2012). x is the request, y the command, on each axis of
//! (v_f, ω_t, ω_s), m/s and rad/s:
//!
//! ```text
//! r' = (x' − r)/T_r,   y' = (x − y)/τ,   τ = τ_0/(1 + |r|/r_0).
//! ```
//!
//! A plan holds for a whole step, so it leads by half a step. In fine steps the filter adds the missing lead along r,
//! where requests change steadily: a body lags hardly more behind many small steps than behind a few.

use glam::{Vec2, Vec3};
use motiondb::motion::Parameters;

use crate::maths::angle::unit_vector;
use crate::maths::decay::decay;
use crate::synthesis::TimeStep;

/// τ_0: lag behind requests that alternate, s.
const LAG_S: f32 = 0.15;
/// r_0: steady rate of change at which the lag halves, m/s² and rad/s².
const LAG_HALVING_RATE: f32 = 1.0;
/// Half of this duration is the least lead of a command, s; half of a step is the lead of its plan. At 0.1 s bodies
/// that avoid each other accelerate more than they need.
const LEAD_STEP_S: f32 = 0.05;
/// Limit of the rate of change between two requests, m/s² and rad/s²: what a body can follow.
const RATE_MAX: f32 = 3.0;

/// The command of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CommandFilter {
    /// The command y.
    pub command: Parameters,
    /// Request x of the last step.
    requested: Vec3,
    /// Steady rate of change r, per second.
    steady_rate: Vec3,
    /// Rate of change x' in the last step, limited, per second.
    last_rate: Vec3,
}

impl CommandFilter {
    /// Follows a request. The command of a standing body does not lag: a standing body does not tremble.
    pub(crate) fn follow(&mut self, requested: Parameters, stands: bool, step: &TimeStep) {
        let requested = requested.to_vec3();
        let rate = (requested - self.requested) / step.dt_s;
        self.steady_rate += (1.0 - step.command_rate_left) * (rate - self.steady_rate);
        (self.requested, self.last_rate) = (requested, rate.clamp_length_max(RATE_MAX));
        let lags = step.dt_s / LAG_S * (1.0 + self.steady_rate.length() / LAG_HALVING_RATE);
        let share = if stands { 1.0 } else { 1.0 - decay(lags) };
        let command = self.command.to_vec3();
        let leading = requested + 0.5 * (LEAD_STEP_S - step.dt_s).max(0.0) * self.agreed_rate();
        self.command = Parameters::from_vec3(command + share * (leading - command));
    }

    /// The command after some time if requests go on changing as they do.
    pub(crate) fn ahead(&self, time_s: f32) -> Parameters {
        Parameters::from_vec3(self.command.to_vec3() + time_s * self.agreed_rate())
    }

    /// Rate of change on which the steady and the last one agree: 0 on axes where requests have just jumped, or rest.
    fn agreed_rate(&self) -> Vec3 {
        let agree = (self.steady_rate * self.last_rate).cmpgt(Vec3::ZERO);
        let rate = self.steady_rate.signum() * self.steady_rate.abs().min(self.last_rate.abs());
        Vec3::select(agree, rate, Vec3::ZERO)
    }

    /// Rotates all velocities into the frame of a body that has turned: requests of m_sp are constant in the world.
    pub(crate) fn turn(&mut self, turned_rad: f32) {
        let back = unit_vector(-turned_rad);
        let rotated = |vector: Vec3| {
            let velocity = back.rotate(Vec2::new(vector.x, vector.z));
            Vec3::new(velocity.x, vector.y, velocity.y)
        };
        self.command = Parameters::from_vec3(rotated(self.command.to_vec3()));
        [self.requested, self.steady_rate, self.last_rate] =
            [self.requested, self.steady_rate, self.last_rate].map(rotated);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Commanded speeds for speeds requested step by step, m/s.
    fn commands_mps(dt_s: f32, requests_mps: impl Iterator<Item = f32>) -> Vec<f32> {
        let mut filter = CommandFilter::default();
        let follow = |speed_mps| {
            filter.follow(Parameters { speed_mps, ..Parameters::default() }, false, &TimeStep::new(dt_s));
            filter.command.speed_mps
        };
        requests_mps.map(follow).collect()
    }

    #[test]
    fn alternating_requests_are_damped() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let speeds_mps = commands_mps(dt_s, (0..200).map(|step| if step % 2 == 0 { 1.2 } else { 1.0 }));
            let swing_mps = (speeds_mps[199] - speeds_mps[198]).abs();
            assert!(swing_mps < 0.13, "dt {dt_s}: {swing_mps} m/s of 0.2");
        }
    }

    /// Displacement by which commands fall behind requests that grow by 2.5 m/s² to 1 m/s, m.
    fn behind_m(dt_s: f32) -> f32 {
        let speed_mps = |step: usize| (2.5 * step as f32 * dt_s).min(1.0);
        let steps = (2.0 / dt_s) as usize;
        let commands_mps = commands_mps(dt_s, (0..steps).map(speed_mps));
        (0..steps).map(|step| dt_s * (speed_mps(step) - commands_mps[step])).sum()
    }

    #[test]
    fn steady_changes_are_followed_closely() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            assert!(behind_m(dt_s) < 0.06, "dt {dt_s}: {} m", behind_m(dt_s));
        }
    }

    #[test]
    fn fine_steps_lag_hardly_more_than_coarse_ones() {
        let [fine_m, coarse_m] = [1.0 / 240.0, 1.0 / 30.0].map(behind_m);
        assert!(fine_m < 1.15 * coarse_m, "{fine_m} m, {coarse_m} m");
    }

    #[test]
    fn a_constant_world_velocity_does_not_lag() {
        let mut filter = CommandFilter::default();
        let request = |facing_rad: f32| Parameters {
            speed_mps: libm::cosf(facing_rad),
            turn_rate_rad_s: 0.0,
            strafe_mps: -libm::sinf(facing_rad),
        };
        filter.follow(request(0.0), true, &TimeStep::new(0.1));
        for step in 1..20 {
            filter.turn(0.1);
            let requested = request(0.1 * step as f32);
            filter.follow(requested, false, &TimeStep::new(0.1));
            assert!((filter.command.to_vec3() - requested.to_vec3()).length() < 1e-4);
        }
    }
}

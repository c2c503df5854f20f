//! Standing or stepping: a body stands, or it takes steps that lift its feet.
//!
//! A mix of little steps and much idle lifts no foot: by the blended contact Σ w·c both feet stay planted as long as
//! standing has the greater share. So a body stands, or it takes at least the *least steps*, a mix with
//! [`IDLE_SHARE_MAX`] of standing. Slower steps are the least steps at a lower playback rate, down to
//! [`PLAYBACK_RATE_MIN`]. A body that stops does so as soon as both feet are planted: its root comes to rest as the
//! command does, and settling steps bring the feet under it ([`crate::synthesis::pose::settling_step`]).
//!
//! Parameters are (v_f, ω_t, ω_s) in the body's frame, m/s and rad/s; shares are shares of time.

use motiondb::blend_space::Shares;
use motiondb::motion::Parameters;

use crate::synthesis::Traits;
use crate::synthesis::blending::{BlendDomain, Reachable};
use crate::synthesis::command::command_filter::CommandFilter;

/// Greatest share of standing examples in steps: with more, the blended contact of a swinging foot stays above ½.
const IDLE_SHARE_MAX: f32 = 0.35;
/// Least playback rate of the least steps: a cadence of half a stroll's.
pub(crate) const PLAYBACK_RATE_MIN: f32 = 0.3;
/// Share of standing in the command below which a standing body starts to step.
pub const START_IDLE_SHARE: f32 = 0.8;
/// Share of standing in the command above which a stepping body stops. The slowest steps have
/// 0.805 = 1 − [`PLAYBACK_RATE_MIN`]·(1 − [`IDLE_SHARE_MAX`]), between start and stop.
const STOP_IDLE_SHARE: f32 = 0.82;
/// Share of standing in the command above which a stepping body stops at once: not even a direction is left.
const HALT_IDLE_SHARE: f32 = 0.95;
/// Greatest speed of the slowest walk for idle shares, m/s. In a set without slow walks, fast ones mix with so much
/// standing that no body would start.
const SLOWEST_WALK_MAX_MPS: f32 = 1.3;
/// Least duration of standing and of stepping, s: about a step. A planner that leads from the present velocity requests
/// it a little longer.
const STATE_DURATION_S: f32 = 0.4;
/// Time ahead at which a command that passes through rest is evaluated, s: the duration of a change from one side-step
/// to the other at 2.5 m/s².
const PASSING_TIME_S: f32 = 0.2;
/// Time ahead at which a command that comes to rest is evaluated, s: the duration of the last step.
const LAST_STEP_S: f32 = 0.35;
/// Greatest time for which a stopping body that could blend waits until both feet are planted, s: those of a run never are.
const STOPPING_MAX_S: f32 = 1.2;
/// Share of the current velocity in the last step of a body whose command rests, unless the least steps are faster.
const LAST_STEP_SPEED_SHARE: f32 = 0.25;
/// Speed below which the root of a standing body rests, m/s.
const RESTING_MPS: f32 = 0.02;

/// Whether a body stands or steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepState {
    /// Whether the body stands, both feet on the ground.
    pub stands: bool,
    /// Duration of the present state, s.
    duration_s: f32,
    /// Time for which the body has been waiting until both feet are planted, s; 0 while it is not to stop.
    stopping_s: f32,
}

impl StepState {
    /// A body that stands and may start at once.
    pub(crate) const STANDING: Self = Self { stands: true, duration_s: STATE_DURATION_S, stopping_s: 0.0 };

    /// Follows what the examples reach of the command, with hysteresis. `comes_to_rest` states whether the command will
    /// rest by the end of a step, `feet_planted` whether both feet are, and `may_blend` whether the body could blend now.
    /// Returns whether the body starts to step.
    pub(crate) fn follow(
        &mut self,
        reachable: &Reachable,
        comes_to_rest: bool,
        feet_planted: bool,
        may_blend: impl FnOnce() -> bool,
        dt_s: f32,
    ) -> bool {
        let idle_share = reachable.idle_share.min(idle_share_max(reachable.parameters));
        let may_change = self.duration_s >= STATE_DURATION_S;
        let rests = idle_share > STOP_IDLE_SHARE || comes_to_rest;
        let stop = !self.stands && (may_change && rests || idle_share > HALT_IDLE_SHARE);
        let start = self.stands && may_change && idle_share < START_IDLE_SHARE;
        self.stopping_s = if stop { self.stopping_s + dt_s } else { 0.0 };
        let on_feet = feet_planted || self.stopping_s > STOPPING_MAX_S;
        if start || stop && on_feet && may_blend() {
            *self = Self { stands: !self.stands, duration_s: 0.0, stopping_s: 0.0 };
        }
        self.duration_s += dt_s;
        start
    }

    /// What the examples reach of a command. Where the command of a stepping body passes through rest, the command
    /// [`PASSING_TIME_S`] later counts.
    pub(crate) fn reachable(&self, filter: &CommandFilter, domain: &BlendDomain, traits: &Traits) -> Reachable {
        let reachable = domain.reachable_with(filter.command, traits.cadence);
        let rests = !self.stands && reachable.idle_share > STOP_IDLE_SHARE;
        let later = filter.ahead(PASSING_TIME_S);
        if rests && idle_share_max(later) < STOP_IDLE_SHARE {
            domain.reachable_with(later, traits.cadence)
        } else {
            reachable
        }
    }

    /// Whether the command of a stepping body, slower than its least steps, will rest when the next step has landed.
    pub(crate) fn comes_to_rest(
        &self,
        reachable: &Reachable,
        filter: &CommandFilter,
        domain: &BlendDomain,
        traits: &Traits,
    ) -> bool {
        let slows_down = || domain.reachable_with(filter.ahead(LAST_STEP_S), traits.cadence);
        !self.stands && reachable.idle_share > IDLE_SHARE_MAX && slows_down().idle_share > STOP_IDLE_SHARE
    }

    /// Whether the body steps only until both feet are planted.
    pub(crate) fn is_stopping(&self) -> bool {
        self.stopping_s > 0.0
    }

    /// Whether the body stops where its swinging foot lands. A foot that swings for longer has a long step, and its root must
    /// come over the other one.
    pub(crate) fn stops(&self) -> bool {
        self.is_stopping() && self.stopping_s < LAST_STEP_S
    }

    /// Whether the body walks and its command continues the walk.
    pub(crate) fn walks_on(&self, reachable: &Reachable) -> bool {
        !self.stands && reachable.idle_share < IDLE_SHARE_MAX
    }

    /// Target of the active motion: what the examples reach of the command, at no less than the least steps. The root of a
    /// body that stands, at its `current` parameters, comes to rest as the command does.
    pub(crate) fn target(
        &self,
        reachable: &Reachable,
        current: Parameters,
        domain: &BlendDomain,
        traits: &Traits,
    ) -> Parameters {
        if self.stands {
            let (current, wanted) = (current.to_vec3(), reachable.parameters.to_vec3());
            let share = wanted.dot(current) / current.length_squared().max(f32::MIN_POSITIVE);
            let slowed = Parameters::from_vec3(share.clamp(0.0, 1.0) * current);
            let rests = slowed.velocity_mps().length() < RESTING_MPS;
            return if rests { domain.standing.parameters } else { slowed };
        }
        let steps = if reachable.idle_share > HALT_IDLE_SHARE {
            let last_step = Parameters::from_vec3(LAST_STEP_SPEED_SHARE * current.to_vec3());
            &domain.reachable_with(last_step, traits.cadence)
        } else {
            reachable
        };
        let playback_rate_min = if self.is_stopping() { 1.0 } else { PLAYBACK_RATE_MIN };
        // Standing lies at the origin, so a scaled point has the scaled share of steps.
        let stepping_share = (1.0 - steps.idle_share).max(1.0 - HALT_IDLE_SHARE);
        let scale = (playback_rate_min * (1.0 - IDLE_SHARE_MAX) / stepping_share).max(1.0);
        Parameters::from_vec3(scale * steps.parameters.to_vec3())
    }

    /// Shares, and playback rate over that of the body's steps, for parameters that the examples reach. For very slow ones the
    /// rate is less than [`PLAYBACK_RATE_MIN`].
    pub(crate) fn playback(&self, reachable: &Reachable, domain: &BlendDomain) -> (Shares, f32) {
        let stepping_share = 1.0 - reachable.idle_share;
        if self.stands || stepping_share >= 1.0 - IDLE_SHARE_MAX || stepping_share <= 0.0 {
            return (reachable.shares, 1.0);
        }
        let rate = stepping_share / (1.0 - IDLE_SHARE_MAX);
        let least_steps = Parameters::from_vec3(reachable.parameters.to_vec3() / (rate * reachable.playback_rate));
        (domain.locate(least_steps), rate)
    }
}

/// Greatest share of standing that a speed counts as.
fn idle_share_max(parameters: Parameters) -> f32 {
    1.0 - parameters.velocity_mps().length() / SLOWEST_WALK_MAX_MPS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_stands_only_where_it_can_blend() {
        let rests = Reachable { idle_share: 1.0, ..Reachable::default() };
        for (feet_planted, may_blend) in [(true, false), (false, false), (true, true), (false, true)] {
            let mut step_state = StepState { stands: false, ..StepState::STANDING };
            let mut stands_after = |steps: usize| {
                for _ in 0..steps {
                    step_state.follow(&rests, true, feet_planted, || may_blend, 0.1);
                }
                step_state.stands
            };
            assert_eq!([stands_after(1), stands_after(20)], [feet_planted && may_blend, may_blend]);
        }
    }

    #[test]
    fn bodies_without_slow_steps_start_too() {
        // Half a second's acceleration, of which a walk at 4 m/s is a twelfth.
        let parameters = Parameters { speed_mps: 0.33, ..Parameters::default() };
        let reachable = Reachable { parameters, idle_share: 0.92, playback_rate: 1.0, ..Reachable::default() };
        let mut step_state = StepState::STANDING;
        assert!(step_state.follow(&reachable, false, true, || true, 1.0 / 30.0));
    }
}

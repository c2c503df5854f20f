//! Weight transition: how the shares of a mix change over time, at limited accelerations of the root and at a limited
//! speed of the pose.
//!
//! The root moves straight from its current parameters towards the target. The shares are those of the next point on
//! the line, so a body passes the examples between. In three cases the shares move to those at the target instead:
//!
//! - where simplices are slim, poses differ much from one such point to the next, and following them would take too
//!   long;
//! - where the line passes rest, near which the examples have no steps: a body that reverses would otherwise keep the
//!   least steps of its old direction;
//! - where a body at the next point would slow down so that it need not run: one that is to run would never come there.
//!
//! Parameters (v_f, ω_t, ω_s), m/s and rad/s.

use motiondb::blend_space::Shares;
use motiondb::motion::Parameters;

use crate::synthesis::blending::{ExampleMix, Reachable};
use crate::synthesis::command::acceleration_limit::limited_along_line;
use crate::synthesis::command::step_state::{PLAYBACK_RATE_MIN, StepState};
use crate::synthesis::{SynthesisContext, Traits};

/// Distance from a point up to which a body reaches it, m/s and rad/s.
const REACHED: f32 = 0.01;

/// Shares and playback rate to move to.
struct ShareTarget {
    shares: Shares,
    playback_rate: f32,
    /// Whether the playback rate is the least.
    creeps: bool,
    /// Whether a body does not reach the point.
    falls_short: bool,
    /// Fraction of the change of shares in this step.
    fraction: f32,
    /// Fraction of the line to the target that the root then has passed.
    passed: f32,
}

/// Moves a mix by one step towards `target`. `known` is what the examples reach of the command: the target, mostly.
pub(crate) fn follow(
    mix: &mut ExampleMix,
    target: Parameters,
    known: &Reachable,
    step_state: StepState,
    traits: &Traits,
    context: &SynthesisContext,
    dt_s: f32,
) {
    let current = mix.parameters(&context.db);
    let next = limited_along_line(current, target, &context.params, dt_s);
    let line = target.to_vec3() - current.to_vec3();
    let next_part = (next.to_vec3() - current.to_vec3()).length() / line.length().max(f32::MIN_POSITIVE);
    let share_target = |point: Parameters, part: f32| {
        let reachable = || context.domain.reachable_with(point, traits.cadence);
        let reachable = if point == known.parameters { *known } else { reachable() };
        let (shares, slowing) = step_state.playback(&reachable, &context.domain);
        // The root accelerates no faster than its limit.
        let fraction =
            pose_limited_fraction(mix, &shares, context, dt_s).min(next_part / part.max(f32::MIN_POSITIVE)).min(1.0);
        ShareTarget {
            shares,
            playback_rate: slowing.max(PLAYBACK_RATE_MIN) * reachable.playback_rate,
            creeps: slowing <= PLAYBACK_RATE_MIN,
            falls_short: reachable.parameters.to_vec3().distance(point.to_vec3()) > REACHED,
            fraction,
            passed: fraction * part,
        }
    };
    let near = share_target(next, next_part);
    let must_pass = near.creeps || near.falls_short;
    let far = (next != target && (must_pass || near.fraction < 1.0)).then(|| share_target(target, 1.0));
    let far = far.filter(|far| must_pass || far.passed > near.passed);
    let ShareTarget { shares, playback_rate, fraction, .. } = far.unwrap_or(near);
    mix.approach(&shares, playback_rate, fraction);
}

/// Fraction of the change to some shares that the speed limit of the pose allows in one step.
pub(crate) fn pose_limited_fraction(mix: &ExampleMix, shares: &Shares, context: &SynthesisContext, dt_s: f32) -> f32 {
    let change_max_m = context.params.pose_change_max_mps * dt_s;
    let landmarks = &context.domain.landmarks;
    if landmarks.change_max_m(mix.changed_share(shares)) <= change_max_m {
        return 1.0;
    }
    let change_m = landmarks.change_m(mix.changes_to(shares));
    if change_m <= change_max_m { 1.0 } else { change_max_m / change_m }
}

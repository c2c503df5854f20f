//! How a mix of examples follows what a body makes for: through the space of parameters at limited accelerations, and
//! through that of poses at a limited speed.
//!
//! The root moves straight from the parameters that the mix has towards those it makes for; the shares are those of the
//! next point on that way, so a body passes the examples between. Where simplices are slim, poses differ much from one
//! such point to the next, and following them would take for ever: then the shares move to those at the end of the way.
//! They do so too where the way leads through rest, about which there are no steps so small: a body that goes the other
//! way would else keep to the least steps of its first one.

use motiondb::blend_space::Shares;
use motiondb::motion::Parameters;

use crate::synthesis::Motion;
use crate::synthesis::blending::blend_space::Nearest;
use crate::synthesis::blending::mix::Mix;
use crate::synthesis::command::blend_query;
use crate::synthesis::command::stand_or_step::{self, Gait};

/// A mix to move to, and how much of it may be taken up in this step.
struct Target {
    shares: Shares,
    pace: f32,
    fraction: f32,
    /// Share of the way to the goal that is then gone.
    gone: f32,
}

/// Moves the mix by one step towards `goal`. What is nearest to one point, mostly the goal itself, is known already.
pub(crate) fn follow(mix: &mut Mix, goal: Parameters, known: &Nearest, gait: Gait, motion: &Motion, dt_s: f32) {
    let now = mix.parameters(motion.db);
    let next = blend_query::step_towards(now, goal, motion.params, dt_s);
    let way = goal.to_vec3() - now.to_vec3();
    let step = (next.to_vec3() - now.to_vec3()).length() / way.length().max(f32::MIN_POSITIVE);
    let target = |at: Parameters, part: f32| {
        let nearest = if at == known.parameters { *known } else { motion.space.nearest(at) };
        let (shares, pace) = stand_or_step::steps(&nearest, gait, motion.space);
        // No faster than the root may accelerate.
        let fraction = fraction(mix, &shares, motion, dt_s).min(step / part.max(f32::MIN_POSITIVE)).min(1.0);
        Target { shares, pace, fraction, gone: fraction * part }
    };
    let near = target(next, step);
    let creeps = near.pace <= stand_or_step::PACE_MIN;
    let far = (next != goal && (creeps || near.fraction < 1.0)).then(|| target(goal, 1.0));
    let far = far.filter(|far| creeps || far.gone > near.gone);
    let Target { shares, pace, fraction, .. } = far.unwrap_or(near);
    mix.approach(&shares, pace, fraction);
}

/// How much of the way to some shares the pose may go in a step.
pub(crate) fn fraction(mix: &Mix, shares: &Shares, motion: &Motion, dt_s: f32) -> f32 {
    let change_max_m = motion.params.pose_change_max_mps * dt_s;
    if motion.space.pose_change_max_m(mix.change_to(shares)) <= change_max_m {
        return 1.0;
    }
    let change_m = motion.space.pose_change_m(mix.changes_to(shares));
    if change_m <= change_max_m { 1.0 } else { change_max_m / change_m }
}

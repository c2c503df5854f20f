//! Decoupled bodies: the baseline of the paper's user study (`FbCrowd` §7), "we used ORCA to first generate 2D
//! trajectories and then a motion blending based synthesis method which exactly followed the 2D trajectory".
//!
//! The disc moves exactly as planned; the limits of the body are ignored. The root takes the disc's position. The body
//! turns towards the planned facing, which for ORCA is the direction of travel. The pose is a blend of what the
//! examples reach of the (v_f, ω_t, ω_s) of each step. Beyond that, feet slide: foot locks are not part of the paper.
//! ORCA reads nothing of a body, so planning step by step equals planning first.
//!
//! The paper does not state how its bodies turn. Here they turn as in two-way coupling: by the remaining angle over
//! T_turn, and no faster than the fastest example. A disc in a crowd changes its direction of travel by up to 180°
//! within a step; a body that faced it at every instant would spin.
//!
//! World frame; metres, seconds, radians.

use motiondb::body::Root;

use crate::maths::angle::wrap_rad;
use crate::maths::arc::parameters_between;
use crate::synthesis::command::weight_transition::pose_limited_fraction;
use crate::synthesis::synthesize::output;
use crate::synthesis::{Body, BodyOutput, SynthesisContext};

/// Lets a body follow its disc, which has moved from the root `from` to the body's root and faces as planned.
pub(crate) fn follow(body: &mut Body, context: &SynthesisContext, from: Root, dt_s: f32) -> BodyOutput {
    let remaining_rad = wrap_rad(body.root.facing_rad - from.facing_rad);
    let share = (dt_s / context.params.turn_time_s).min(1.0);
    let turn_max_rad = context.domain.turn_rate_max_rad_s * dt_s;
    let turn_rad = (share * remaining_rad).clamp(-turn_max_rad, turn_max_rad);
    body.root.facing_rad = wrap_rad(from.facing_rad + turn_rad);

    let motion = &mut body.motion;
    let shares = context.domain.locate(parameters_between(&from, &body.root, dt_s));
    motion.mix.approach(&shares, 1.0, pose_limited_fraction(&motion.mix, &shares, context, dt_s));
    motion.smoothed[0].mix = motion.mix;
    motion.phase = motion.mix.advanced_phase(&context.db, motion.phase, dt_s);
    let active = motion.active(context);
    let posture = active.posture(context, motion.phase);
    let soles_m = posture.soles_m(&context.db.skeleton);
    output(&active, [motion.phase, 1.0], &posture, &soles_m, &body.root.frame(), context)
}

//! The rival of the paper's user study (`FbCrowd` §7): "we used ORCA to first generate 2D trajectories and then a
//! motion blending based synthesis method which exactly followed the 2D trajectory".
//!
//! The disc moves exactly as planned, whatever a body could do, and the body is carried along: its root is the disc's
//! place, it turns towards the planned facing, which for ORCA is the direction of travel, and its pose is blended of
//! what the examples have nearest to the (v_f, ω_t, ω_s) of each step. Where they lack it, feet slide: none is held by
//! IK, which is ours, not the paper's. ORCA looks at nothing of a body, so planning step by step is planning first.
//!
//! How its bodies turn the paper does not say. Here as in two-way coupling, by the angle left over T_turn and no faster
//! than the fastest example: a disc that is pushed about turns its direction of travel by up to 180° within a step, and
//! a body that faced it at every instant would spin.

use motiondb::body::Root;

use crate::maths::angle::wrap_rad;
use crate::synthesis::{Body, Motion, Synthesis};

/// Lets a body follow its disc, which has moved `from` a root to where the body's root is now and faces as planned.
pub(crate) fn follow(body: &mut Body, motion: &Motion, from: Root, dt_s: f32) -> Synthesis {
    let left_rad = wrap_rad(body.root.facing_rad - from.facing_rad);
    let share = (dt_s / motion.params.turn_time_s).min(1.0);
    let turn_max_rad = motion.space.turn_rate_max_rad_s * dt_s;
    body.root.facing_rad = wrap_rad(from.facing_rad + (share * left_rad).clamp(-turn_max_rad, turn_max_rad));
    body.follow(motion, from, dt_s)
}

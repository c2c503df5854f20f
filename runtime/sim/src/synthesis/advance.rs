//! The first half of a step: a body follows its plan.
//!
//! [`Body::advance`] lists the stages. Plans and roots are in the world, parameters (v_f, ω_t, ω_s) in the body's frame
//! (x forward, y left); metres, seconds, radians.

use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::Parameters;

use crate::maths::arc::moved_root;
use crate::planning::plan::Plan;
use crate::synthesis::command::start_stop::{first_step_phase, stance_foot};
use crate::synthesis::hybrid::{ExtraState, MotionState};
use crate::synthesis::pose::{ContactState, FootLock};
use crate::synthesis::{Body, SynthesisContext, TimeStep};

impl Body {
    /// Follows a plan over one step: command, motion and root. Walls may then move the root
    /// ([`place_root`](Self::place_root)) before [`synthesize`](Self::synthesize).
    pub fn advance(&mut self, context: &SynthesisContext, plan: &Plan, step: &TimeStep) {
        self.advance_with(&mut ExtraState::default(), context, plan, step);
    }

    /// Follows a plan over one step as [`advance`](Self::advance) does; where the motion jumps, the extra joints of the
    /// body do not. Their rotations follow with [`pose_extra`](Self::pose_extra).
    pub fn advance_with(&mut self, extra: &mut ExtraState, context: &SynthesisContext, plan: &Plan, step: &TimeStep) {
        self.room = plan.room.seen_from(-self.root.position_m, Vec2::X);
        let Self {
            root, actual_mps, command, motion, contact, look_at, lean, secondary, squeeze, weight_shift, ..
        } = self;
        let plan = command.accumulator.follow(plan, *actual_mps, step);
        let (traits, deformed) = (motion.traits, motion.deformed(context));
        let reachable = command.follow(&plan, root.facing_rad, deformed, &traits, context, step);
        let feet_planted = contact.locks.iter().all(FootLock::planted);
        let rests = command.step_state.comes_to_rest(&reachable, &command.filter, &context.domain, &traits);
        let may_blend = || motion.may_blend(context);
        if command.step_state.follow(&reachable, rests, feet_planted, may_blend, step.dt_s) {
            let phase = first_step_phase(command.filter.command, contact, root, &context.domain, &traits);
            let stance = stance_foot(phase);
            if let Some(action) = context.starts.fitting(command.filter.command, 1 - stance) {
                motion.begin_transition(extra, action, context, step);
            } else {
                motion.jump(extra, context, step, |motion| motion.phase = phase);
                weight_shift.begin(stance);
            }
        }
        if command.step_state.stands {
            motion.stand(extra, &command.step_state, context, step);
        }
        let target = motion.target(command, &reachable, context);
        motion.approach(target, &reachable, command, context, step.dt_s);
        let current = motion.current(&context.db);
        *actual_mps = move_root(root, &current, step.dt_s);
        let phase_before = motion.phase;
        let stops = command.step_state.stops();
        let rate_factor = match phase_rate_factor(motion, &current, contact, root, *actual_mps, step) {
            // A foot that lands for the stop does not wait until the root is over the other one.
            factor if stops => factor.max(1.0),
            factor => factor,
        };
        motion.take_steps(root, target, rate_factor, stops, context, step);
        let advanced = motion.phase - phase_before;
        motion.idle.advance(&context.db, command.step_state.stands, step.dt_s);
        let reverses = motion.smooth(&context.db, step);
        motion.inertialization.decay(step);
        extra.decay(step);
        motion.end_transition(extra, command.step_state.stands, context, step);
        motion.select(&plan, command.step_state.walks_on(&reachable), context, step.dt_s);
        motion.switch(extra, phase_before, &command.step_state, context, step);
        if reverses {
            motion.jump(extra, context, step, MotionState::reverse);
        }
        look_at.follow(&plan, root.facing_rad, step);
        let drawn = motion.drawn_parameters(&context.db);
        lean.follow(drawn, motion.played_leans_rad(context), step);
        let walking = drawn.velocity_mps().length() / context.base_mps;
        squeeze.follow([plan.gap_m, plan.room.gap_m(root.forward())], context.shoulder_breadth_m, step);
        secondary.follow(motion.phase, advanced, walking, step);
    }
}

/// Moves the root along the arc of the parameters. Returns its velocity, world, m/s.
fn move_root(root: &mut Root, parameters: &Parameters, dt_s: f32) -> Vec2 {
    let from_m = root.position_m;
    *root = moved_root(root, parameters, dt_s);
    (root.position_m - from_m) / dt_s
}

/// Factor on the phase rate by which the motion catches up with the planted feet.
fn phase_rate_factor(
    motion: &mut MotionState,
    current: &Parameters,
    contact: &ContactState,
    root: &Root,
    actual_mps: Vec2,
    step: &TimeStep,
) -> f32 {
    let carried_mps = |ball_m: Vec2| actual_mps + current.turn_rate_rad_s * (ball_m - root.position_m).perp();
    motion.phase_catch_up.follow(&contact.locks, |foot| carried_mps(foot.ball_m().truncate()), step)
}

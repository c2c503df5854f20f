//! A single body on open ground, advanced as in a simulation: the subject of the benches of synthesis.

use std::sync::Arc;

use fbcrowd_sim::maths::{parameters_between, wrap_rad};
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::command::plan_requesting;
use fbcrowd_sim::synthesis::{HmsParams, Modes, SynthesisContext};
use glam::Vec3;
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters};

/// Time steps at which the criteria of synthesis must hold, s: of a display, of a film, and of Table 1.
pub(crate) const TIME_STEPS_S: [f32; 3] = [1.0 / 120.0, 1.0 / 30.0, 0.1];

/// A database, prepared for one kind of synthesis.
pub(crate) fn context(db: MotionDb, modes: Modes) -> SynthesisContext {
    SynthesisContext::new(Arc::new(db), HmsParams { modes, ..HmsParams::default() })
}

/// Roots of a body that follows a plan of time and root: at the start, and after each step.
pub(crate) fn roots(
    context: &SynthesisContext,
    seconds: f32,
    dt_s: f32,
    plan: impl Fn(f32, &Root) -> Plan,
) -> Vec<Root> {
    context.walk_alone(0.0, seconds, dt_s, plan, |body, _| body.root)
}

/// As [`roots`], of a body that follows parameters of time.
pub(crate) fn commanded_roots(
    context: &SynthesisContext,
    seconds: f32,
    dt_s: f32,
    parameters: impl Fn(f32) -> Parameters,
) -> Vec<Root> {
    roots(context, seconds, dt_s, |time_s, root| plan_requesting(parameters(time_s), root, &context.params))
}

/// Angle by which a root turns in a step, rad.
pub(crate) fn turned_rad(before: &Root, after: &Root) -> f32 {
    wrap_rad(after.facing_rad - before.facing_rad)
}

/// Mean (v_f, ω_t, ω_s) of a root over some steps; the displacement of each step is taken as an arc.
pub(crate) fn achieved(roots: &[Root], dt_s: f32) -> Parameters {
    let of_steps = roots.windows(2).map(|pair| parameters_between(&pair[0], &pair[1], dt_s).to_vec3());
    Parameters::from_vec3(of_steps.sum::<Vec3>() / (roots.len() - 1) as f32)
}

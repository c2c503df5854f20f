//! A body alone, stepped as in a simulation: what the benches of synthesis let walk.

use std::sync::Arc;

use fbcrowd_sim::maths::{parameters_between, wrap_rad};
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::command::plan_requesting;
use fbcrowd_sim::synthesis::{HmsParams, Modes, SynthesisContext};
use glam::Vec3;
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters};

/// Steps of time in which the bars of synthesis shall hold, s: a display's, a film's, and that of Table 1.
pub(super) const DT_S: [f32; 3] = [1.0 / 120.0, 1.0 / 30.0, 0.1];

/// A database, ready for a synthesis.
pub(super) fn studio(db: MotionDb, modes: Modes) -> SynthesisContext {
    SynthesisContext::new(Arc::new(db), HmsParams { modes, ..HmsParams::default() })
}

/// The roots of a body that follows a plan of time and root; as it stood at first, and after each step.
pub(super) fn roots(
    studio: &SynthesisContext,
    seconds: f32,
    dt_s: f32,
    plan: impl Fn(f32, &Root) -> Plan,
) -> Vec<Root> {
    studio.walk_alone(0.0, seconds, dt_s, plan, |body, _| body.root)
}

/// As [`roots`], of one that is asked for parameters by the time.
pub(super) fn asked_roots(
    studio: &SynthesisContext,
    seconds: f32,
    dt_s: f32,
    parameters: impl Fn(f32) -> Parameters,
) -> Vec<Root> {
    roots(studio, seconds, dt_s, |time_s, root| plan_requesting(parameters(time_s), root, &studio.params))
}

/// The angle by which a root turned in a step, rad.
pub(super) fn turned_rad(before: &Root, after: &Root) -> f32 {
    wrap_rad(after.facing_rad - before.facing_rad)
}

/// What a root did over some steps: its mean (v_f, ω_t, ω_s), each step's way taken as an arc.
pub(super) fn achieved(roots: &[Root], dt_s: f32) -> Parameters {
    let went = roots.windows(2).map(|pair| parameters_between(&pair[0], &pair[1], dt_s).to_vec3());
    Parameters::from_vec3(went.sum::<Vec3>() / (roots.len() - 1) as f32)
}

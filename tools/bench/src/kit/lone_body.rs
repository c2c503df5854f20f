//! A single body on open ground, advanced as in a simulation: the subject of the benches of synthesis.

use std::sync::Arc;

use fbcrowd_sim::angle::wrap_rad;
use fbcrowd_sim::hms::arc::went;
use fbcrowd_sim::hms::asked::asking;
use fbcrowd_sim::hms::params::{HmsParams, Modes};
use fbcrowd_sim::hms::studio::Studio;
use fbcrowd_sim::plan::Plan;
use glam::Vec3;
use motiondb::motion_db::MotionDb;
use motiondb::parameters::Parameters;
use motiondb::pose::Root;

/// Time steps at which the criteria of synthesis must hold, s: of a display, of a film, and of Table 1.
pub(crate) const TIME_STEPS_S: [f32; 3] = [1.0 / 120.0, 1.0 / 30.0, 0.1];

/// A database, prepared for one kind of synthesis.
pub(crate) fn studio(db: MotionDb, modes: Modes) -> Studio {
    Studio::new(Arc::new(db), HmsParams { modes, ..HmsParams::default() })
}

/// Roots of a body that follows a plan of time and root: at the start, and after each step.
pub(crate) fn roots(studio: &Studio, seconds: f32, dt_s: f32, plan: impl Fn(f32, &Root) -> Plan) -> Vec<Root> {
    studio.walk(0.0, seconds, dt_s, plan, |body, _| body.root)
}

/// As [`roots`], of a body that follows parameters of time.
pub(crate) fn commanded_roots(
    studio: &Studio,
    seconds: f32,
    dt_s: f32,
    parameters: impl Fn(f32) -> Parameters,
) -> Vec<Root> {
    roots(studio, seconds, dt_s, |time_s, root| asking(parameters(time_s), root, &studio.params))
}

/// Angle by which a root turns in a step, rad.
pub(crate) fn turned_rad(before: &Root, after: &Root) -> f32 {
    wrap_rad(after.facing_rad - before.facing_rad)
}

/// Mean (v_f, ω_t, ω_s) of a root over some steps; the displacement of each step is taken as an arc.
pub(crate) fn achieved(roots: &[Root], dt_s: f32) -> Parameters {
    let of_steps = roots.windows(2).map(|pair| went(&pair[0], &pair[1], dt_s).to_vec3());
    Parameters::from_vec3(of_steps.sum::<Vec3>() / (roots.len() - 1) as f32)
}

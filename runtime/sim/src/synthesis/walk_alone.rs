//! One body that walks alone on open ground: for benches, tests and short programs.
//!
//! World frame; metres, seconds.

use motiondb::body::Root;

use crate::planning::plan::Plan;
use crate::synthesis::{Body, BodyOutput, SynthesisContext, TimeStep};

impl SynthesisContext {
    /// Lets a body that stands at the origin, with its cycle at `phase`, follow a plan of time and root in steps of
    /// `dt_s`. Returns what `observe` makes of the body at first and after each step.
    pub fn walk_alone<T>(
        &self,
        phase: f32,
        seconds: f32,
        dt_s: f32,
        plan: impl Fn(f32, &Root) -> Plan,
        observe: impl Fn(&Body, &BodyOutput) -> T,
    ) -> Vec<T> {
        let time_step = TimeStep::new(dt_s);
        let (mut body, first) = Body::standing(self, Root::default(), phase);
        let mut observed = vec![observe(&body, &first)];
        for step in 0..(seconds / dt_s).round() as usize {
            body.advance(self, &plan(step as f32 * dt_s, &body.root), &time_step);
            let output = body.synthesize(self, &time_step);
            observed.push(observe(&body, &output));
        }
        observed
    }
}

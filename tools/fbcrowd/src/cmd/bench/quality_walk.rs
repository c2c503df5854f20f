//! Bodies that go on an errand, alone on open ground, and what is kept of every step for the measures.

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::synthesis::{Body, Mode, Modes, SynthesisContext, TimeStep};
use motiondb::body::{Joints, Root};
use motiondb::motion::{MotionDb, Parameters};

use crate::cmd::bench::quality_errands::{Ask, Errand};

/// Bodies on each errand …
pub(super) const BODIES: usize = 8;
/// … which set out this long before one another, s: eight make a stride of 1.1 s.
pub(super) const APART_S: f32 = 0.14;
/// In hybrid synthesis a collision threatens for so long, and then for so long it does not, s.
const THREAT_S: f32 = 2.0;

/// One body after one step.
pub(super) struct Step {
    pub(super) frame: AgentFrame,
    pub(super) joints: Joints,
    /// Planted share of the examples in use, by their shares of time.
    pub(super) examples_planted_share: f32,
    /// The examples in use.
    pub(super) examples: Vec<usize>,
    /// Of the root in this step, m/s.
    pub(super) speed_mps: f32,
    /// The speed that the rows tell of as they were played, less the root's, m/s.
    pub(super) correction_mps: f32,
}

/// All bodies of an errand.
pub(super) struct Walk {
    pub(super) dt_s: f32,
    pub(super) bodies: Vec<Vec<Step>>,
}

/// Every body goes on the errand in steps of dt.
pub(super) fn walk(studio: &SynthesisContext, errand: &Errand, dt_s: f32) -> Walk {
    let bodies = (0..BODIES).map(|index| walk_one(studio, errand, APART_S * index as f32, dt_s)).collect();
    Walk { dt_s, bodies }
}

fn walk_one(studio: &SynthesisContext, errand: &Errand, early_s: f32, dt_s: f32) -> Vec<Step> {
    let (mut body, _) = Body::standing(studio, Root::default(), early_s);
    (0..(errand.seconds() / dt_s).round() as usize)
        .map(|step| {
            let plan = plan(studio, errand.ask(step as f32 * dt_s, early_s), step as f32 * dt_s, &body);
            stepped(studio, &mut body, &plan, dt_s)
        })
        .collect()
}

/// What is asked, under threat every other while.
fn plan(studio: &SynthesisContext, ask: Ask, time_s: f32, body: &Body) -> Plan {
    let threat = studio.params.modes == Modes::SemiProcedural || (time_s / THREAT_S).rem_euclid(2.0) >= 1.0;
    let asked = ask.plan(&body.root, body.motion.mode == Mode::Blending, &studio.params);
    Plan { time_to_collision_s: if threat { 0.5 } else { f32::INFINITY }, ..asked }
}

fn stepped(studio: &SynthesisContext, body: &mut Body, plan: &Plan, dt_s: f32) -> Step {
    let (before, time_step) = (*body, TimeStep::new(dt_s));
    body.advance(studio, plan, &time_step);
    let synthesis = body.synthesize(studio, &time_step);
    let frame = AgentFrame {
        root: body.root,
        planned_mps: plan.velocity_mps,
        phase: body.motion.phase,
        mode: body.motion.mode,
        contacts: synthesis.contacts,
        examples_slide_cm_s: synthesis.examples_slide_cm_s,
        pose: synthesis.pose,
        ..AgentFrame::default()
    };
    let examples = examples(studio, body);
    let planted_shares = examples.iter().map(|&(example, share)| share * studio.db.examples[example].planted_share);
    Step {
        examples_planted_share: planted_shares.sum(),
        examples: examples.into_iter().map(|(example, _)| example).collect(),
        joints: synthesis.pose.forward_kinematics(&studio.db.skeleton),
        speed_mps: (body.root.position_m - before.root.position_m).length() / dt_s,
        correction_mps: correction_mps(&studio.db, &before, body, dt_s),
        frame,
    }
}

/// (example, share of time) of what a body plays.
fn examples(studio: &SynthesisContext, body: &Body) -> Vec<(usize, f32)> {
    match (body.motion.mode, &studio.hybrid) {
        (Mode::SemiProcedural, Some(hybrid)) => vec![(hybrid.base_walk.example, 1.0)],
        _ => body.motion.mix.entries().iter().map(|&(example, share)| (example as usize, share)).collect(),
    }
}

/// Rows that are played faster or slower than their time (a phase that catches up) tell of another speed than the
/// root has. Semi-procedural locomotion moves its feet by the root, whatever the phase.
fn correction_mps(db: &MotionDb, before: &Body, after: &Body, dt_s: f32) -> f32 {
    if (before.motion.mode, after.motion.mode) != (Mode::Blending, Mode::Blending) {
        return 0.0;
    }
    let walked_mps = (after.root.position_m - before.root.position_m).length() / dt_s;
    let middle = before.motion.phase + 0.5 * dt_s * after.motion.mix.phase_rate_hz(db, before.motion.phase);
    let due = dt_s * after.motion.mix.phase_rate_hz(db, middle);
    let passed = (after.motion.phase - before.motion.phase).rem_euclid(1.0);
    let Parameters { speed_mps, strafe_mps, .. } = after.motion.smoothed[0].mix.parameters(db);
    let played = if walked_mps > 0.0 && due > 0.0 { passed / due } else { 1.0 };
    speed_mps.hypot(strafe_mps) * played - walked_mps
}

//! Single bodies on open ground that follow a command sequence, with the state of every step that the measures need.

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::synthesis::{Body, Mode, Modes, SynthesisContext, TimeStep};
use motiondb::body::{Joints, Root};
use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::command_sequences::{Command, CommandSequence};

/// Number of bodies that follow each command sequence.
pub(crate) const BODIES: usize = 8;
/// Time between the starts of two bodies, s: eight make a stride of 1.1 s.
pub(crate) const APART_S: f32 = 0.14;
/// Duration of each interval in which a collision threatens or not, so that hybrid synthesis changes, s.
const THREAT_S: f32 = 2.0;

/// One body after one step.
pub(crate) struct BodyStep {
    pub(crate) frame: AgentFrame,
    pub(crate) joints: Joints,
    /// Planted share of the examples in use, by their shares of time.
    pub(crate) examples_planted_share: f32,
    /// The examples in use.
    pub(crate) examples: Vec<usize>,
    /// Speed of the root in this step, m/s.
    pub(crate) speed_mps: f32,
    /// Speed in the rows as they are played, less the root's speed, m/s.
    pub(crate) correction_mps: f32,
}

/// The walks of all bodies.
pub(crate) struct SequenceWalk {
    pub(crate) dt_s: f32,
    pub(crate) bodies: Vec<Vec<BodyStep>>,
}

/// Every body follows the command sequence with this time step.
pub(crate) fn walk(context: &SynthesisContext, sequence: &CommandSequence, dt_s: f32) -> SequenceWalk {
    let bodies = (0..BODIES).map(|index| walk_one(context, sequence, APART_S * index as f32, dt_s)).collect();
    SequenceWalk { dt_s, bodies }
}

fn walk_one(context: &SynthesisContext, sequence: &CommandSequence, early_s: f32, dt_s: f32) -> Vec<BodyStep> {
    let (mut body, _) = Body::standing(context, Root::default(), early_s);
    (0..(sequence.seconds() / dt_s).round() as usize)
        .map(|step| {
            let plan = plan(context, sequence.at(step as f32 * dt_s, early_s), step as f32 * dt_s, &body);
            body_step(context, &mut body, &plan, dt_s)
        })
        .collect()
}

/// The plan for a command; a collision threatens in every other interval.
fn plan(context: &SynthesisContext, command: Command, time_s: f32, body: &Body) -> Plan {
    let threat = context.params.modes == Modes::SemiProcedural || (time_s / THREAT_S).rem_euclid(2.0) >= 1.0;
    let plan = command.plan(&body.root, body.motion.mode == Mode::Blending, &context.params);
    Plan { time_to_collision_s: if threat { 0.5 } else { f32::INFINITY }, ..plan }
}

/// Advances and synthesises a body.
fn body_step(context: &SynthesisContext, body: &mut Body, plan: &Plan, dt_s: f32) -> BodyStep {
    let (before, time_step) = (*body, TimeStep::new(dt_s));
    body.advance(context, plan, &time_step);
    let synthesis = body.synthesize(context, &time_step);
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
    let examples = examples(context, body);
    let planted_shares = examples.iter().map(|&(example, share)| share * context.db.examples[example].planted_share);
    BodyStep {
        examples_planted_share: planted_shares.sum(),
        examples: examples.into_iter().map(|(example, _)| example).collect(),
        joints: synthesis.pose.forward_kinematics(&context.db.skeleton),
        speed_mps: (body.root.position_m - before.root.position_m).length() / dt_s,
        correction_mps: correction_mps(&context.db, &before, body, dt_s),
        frame,
    }
}

/// Each example in use with its share of time.
fn examples(context: &SynthesisContext, body: &Body) -> Vec<(usize, f32)> {
    match (body.motion.mode, &context.hybrid) {
        (Mode::SemiProcedural, Some(hybrid)) => vec![(hybrid.base_walk.example, 1.0)],
        _ => body.motion.mix.entries().iter().map(|&(example, share)| (example as usize, share)).collect(),
    }
}

/// Speed in the rows as they are played, less the root's speed, m/s: a phase that catches up plays the rows faster or
/// slower than their time. Semi-procedural locomotion moves the feet by the root at any phase.
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
    libm::hypotf(speed_mps, strafe_mps) * played - walked_mps
}

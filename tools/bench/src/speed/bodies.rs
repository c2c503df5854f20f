//! `fbcrowd bench bodies`: the duration of synthesising a body.
//!
//! Bodies at all phases walk and turn at many steady parameters, by a mix of examples or by m_sp deformed. Timed in
//! turns, per body and step, on one thread:
//!
//! - *plain*: four rows summed by weight, and forward kinematics, the least that any blending does;
//! - *blending*: the whole synthesis: query, shares, phase, root, pose, foot hold, pelvis, inverse kinematics of both
//!   legs;
//! - *semi-procedural*: likewise.
//!
//! Ratios are formed within a turn, so that other work of the machine affects all alike; medians count.

use std::hint::black_box;
use std::time::Instant;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::{Body, Modes, SynthesisContext, TimeStep};
use glam::Vec2;
use motiondb::body::{Joints, Root};
use motiondb::motion::{MotionDb, PHASE_COUNT};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::database::bundled;
use crate::kit::lone_body::context;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::statistics::median;

/// Number of bodies: more than a cache holds, as in a large scene.
const BODIES: usize = 1_000;
/// Steps before the first turn, until all bodies move as commanded.
const WARM_UP: usize = 90;
/// Steps of one turn.
const STEPS: usize = 20;
/// Number of turns.
const TURNS: usize = 9;
/// Time step, s.
const DT_S: f32 = 1.0 / 30.0;
/// Middle and half range of the commanded speeds, m/s.
const SPEED_MPS: [f32; 2] = [1.2, 0.4];
/// Half range of the commanded turn rates, rad/s.
const TURN_RATE_RAD_S: f32 = 0.6;
/// Half range of the commanded side speeds, m/s.
const STRAFE_MPS: f32 = 0.15;
/// Greatest ratio of a synthesis to the plain sum.
const OVER_PLAIN: f64 = 5.0;
/// Goal for a synthesis, µs; ozz-animation 0.16 (C++) needs 2.5 µs for the plain sum with 25 joints.
const GOAL_US: f64 = 1.2;

/// Time the synthesis of a body against the least work of any blending.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench bodies --json")]
pub struct Args {}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Mean number of examples in a mix.
    pub examples_mixed: f32,
    /// Four rows summed by weight, and forward kinematics, µs per body and step.
    pub plain_microseconds_per_agent_step: Option<f32>,
    /// Synthesis by blending, µs per body and step.
    pub blending_microseconds_per_agent_step: Option<f32>,
    /// Synthesis by semi-procedural locomotion, µs per body and step.
    pub semi_procedural_microseconds_per_agent_step: Option<f32>,
    /// Median ratio of blending to the plain sum.
    pub blending_over_plain: Option<f32>,
    /// Median ratio of semi-procedural locomotion to the plain sum.
    pub semi_procedural_over_plain: Option<f32>,
}

/// Bodies with one kind of synthesis, and the command of each.
struct BodyCrowd {
    context: SynthesisContext,
    bodies: Vec<Body>,
    /// Velocity in the body's own frame, m/s, and angle from its facing to the wanted facing, rad.
    commands: Vec<(Vec2, f32)>,
}

/// Durations of one turn, µs per body and step.
struct Turn {
    plain_us: f32,
    blending_us: f32,
    semi_procedural_us: f32,
}

/// Runs the bench. It reports no progress: that would take time.
///
/// # Errors
/// If the bundled clips give no database.
pub fn run(_: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = bundled()?;
    let [mut blending, mut semi_procedural] =
        [Modes::Blending, Modes::SemiProcedural].map(|modes| BodyCrowd::new(context(db.clone(), modes)));
    (0..WARM_UP).for_each(|_| [&mut blending, &mut semi_procedural].into_iter().for_each(BodyCrowd::step));
    let entries = |body: &Body| body.motion.mix.entries().len() as f32;
    let examples_mixed = blending.bodies.iter().map(entries).sum::<f32>() / BODIES as f32;
    let turns: Vec<Turn> = (0..TURNS)
        .map(|_| Turn {
            plain_us: microseconds(|| plain(&db, &blending.bodies)),
            blending_us: microseconds(|| blending.step()),
            semi_procedural_us: microseconds(|| semi_procedural.step()),
        })
        .collect();
    let details = Details::new(examples_mixed, &turns);
    let (goals, criteria) = (goals(&details), criteria(&details));
    Ok(BenchReport { text: text(&details), details, goals, criteria })
}

impl Details {
    /// Medians over the turns.
    fn new(examples_mixed: f32, turns: &[Turn]) -> Self {
        let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
        Self {
            examples_mixed,
            plain_microseconds_per_agent_step: of(|turn| turn.plain_us),
            blending_microseconds_per_agent_step: of(|turn| turn.blending_us),
            semi_procedural_microseconds_per_agent_step: of(|turn| turn.semi_procedural_us),
            blending_over_plain: of(|turn| turn.blending_us / turn.plain_us),
            semi_procedural_over_plain: of(|turn| turn.semi_procedural_us / turn.plain_us),
        }
    }
}

fn goals(details: &Details) -> Vec<Goal> {
    let goal = |name, measured: Option<f32>| Goal { name, measured: measured.map(f64::from), goal: GOAL_US };
    vec![
        goal("blending, µs a body and step", details.blending_microseconds_per_agent_step),
        goal("semi-procedural, µs a body and step", details.semi_procedural_microseconds_per_agent_step),
    ]
}

fn criteria(details: &Details) -> Vec<Criterion> {
    let criterion = |name, measured: Option<f32>| Criterion::at_most(name, OVER_PLAIN, measured.map(f64::from));
    vec![
        criterion("blending over four rows and forward kinematics", details.blending_over_plain),
        criterion("semi-procedural over four rows and forward kinematics", details.semi_procedural_over_plain),
    ]
}

impl BodyCrowd {
    fn new(context: SynthesisContext) -> Self {
        let mut random = SplitMix64::new(1, 0);
        let mut within = |range: f32| random.within(f64::from(range)) as f32;
        let bodies = (0..BODIES)
            .map(|index| Body::standing(&context, Root::default(), index as f32 / BODIES as f32).0)
            .collect();
        let commands = (0..BODIES)
            .map(|_| {
                let velocity_mps = Vec2::new(SPEED_MPS[0] + within(SPEED_MPS[1]), within(STRAFE_MPS));
                (velocity_mps, within(TURN_RATE_RAD_S) * context.params.turn_time_s)
            })
            .collect();
        Self { bodies, commands, context }
    }

    /// Advances and synthesises every body.
    fn step(&mut self) {
        let time_step = TimeStep::new(DT_S);
        for (body, &(velocity_mps, ahead_rad)) in self.bodies.iter_mut().zip(&self.commands) {
            let facing_rad = body.root.facing_rad + ahead_rad;
            let velocity_mps = Vec2::from_angle(facing_rad).rotate(velocity_mps);
            body.advance(&self.context, &Plan { velocity_mps, facing_rad, ..Plan::default() }, &time_step);
            black_box(body.synthesize(&self.context, &time_step));
        }
    }
}

/// Sums four rows for each body, those of its mix before the phase, with forward kinematics.
fn plain(db: &MotionDb, bodies: &[Body]) {
    for body in bodies {
        let row = (body.motion.phase * PHASE_COUNT as f32) as usize % PHASE_COUNT;
        black_box(four_rows(db, body.motion.mix.entries(), row));
    }
}

fn four_rows(db: &MotionDb, entries: &[(u32, f32)], row: usize) -> Joints {
    let rows = entries.iter().cycle().take(4).map(|&(example, weight)| (example as usize, row, weight));
    db.rows.blended(rows).forward_kinematics(&db.skeleton)
}

/// Duration of [`STEPS`] steps of all bodies, µs per body and step.
fn microseconds(mut step: impl FnMut()) -> f32 {
    let start = Instant::now();
    (0..STEPS).for_each(|_| step());
    start.elapsed().as_secs_f32() * 1e6 / (STEPS * BODIES) as f32
}

fn text(details: &Details) -> String {
    let figure = |value: Option<f32>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}"));
    format!(
        "µs a body and step: plain {}, blending {} ({:.1} examples mixed), semi-procedural {}\n",
        figure(details.plain_microseconds_per_agent_step),
        figure(details.blending_microseconds_per_agent_step),
        details.examples_mixed,
        figure(details.semi_procedural_microseconds_per_agent_step),
    )
}

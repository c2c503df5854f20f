//! `fbcrowd bench bodies`: what the synthesis of a body costs.
//!
//! Bodies at all phases walk and turn at many steady parameters, by a mix of examples or by m_sp deformed. Timed in
//! turns, per body and step, on one thread:
//!
//! - *plain*: four rows summed by weight, and forward kinematics, the least that any blending does;
//! - *blending*: the whole synthesis: query, shares, phase, root, pose, foot holding, pelvis, two leg IKs;
//! - *semi-procedural*: likewise.
//!
//! Ratios are formed within a turn, so that whatever else the machine does weighs on all alike; medians count.

use std::hint::black_box;
use std::time::Instant;

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::{Body, Modes, SynthesisContext, TimeStep};
use glam::Vec2;
use motiondb::body::{Joints, Root};
use motiondb::motion::{MotionDb, PHASE_COUNT};
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::cmd::bench::bundled::bundled;
use crate::cmd::bench::walker::studio;
use crate::failure::{Answer, Failure};
use crate::statistics::median;

/// Bodies of a crowd: more than the cache holds, as in a large scene.
const BODIES: usize = 1_000;
/// Steps until all play what they are asked for, and of one turn.
const WARM_UP: usize = 90;
const STEPS: usize = 20;
const TURNS: usize = 9;
const DT_S: f32 = 1.0 / 30.0;
/// What bodies are asked for: speed, turn rate and strafe at most this far from their middle.
const SPEED_MPS: [f32; 2] = [1.2, 0.4];
const TURN_RATE_RAD_S: f32 = 0.6;
const STRAFE_MPS: f32 = 0.15;
/// Limit of the bar, and the goal; ozz-animation 0.16 (C++) needs 2.5 µs for as much with 25 joints.
const OVER_PLAIN: f64 = 5.0;
const GOAL_US: f64 = 1.2;

/// Time the synthesis of a body against the least that blending does.
///
/// In JSON `examples_mixed`, the mean number in a mix, `plain_microseconds_per_agent_step`, `blending_…`,
/// `semi_procedural_…`, and `blending_over_plain`, `semi_procedural_over_plain`, medians of the ratios.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench bodies --json")]
pub(super) struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    examples_mixed: f32,
    plain_microseconds_per_agent_step: Option<f32>,
    blending_microseconds_per_agent_step: Option<f32>,
    semi_procedural_microseconds_per_agent_step: Option<f32>,
    blending_over_plain: Option<f32>,
    semi_procedural_over_plain: Option<f32>,
}

/// Bodies that play one synthesis, and what each is asked for: the velocity in its own frame, m/s, and how far ahead
/// of its facing the wanted one is, rad.
struct Walkers {
    studio: SynthesisContext,
    bodies: Vec<Body>,
    asked: Vec<(Vec2, f32)>,
}

/// Times of one turn, µs a body and step.
struct Turn {
    plain_us: f32,
    blending_us: f32,
    semi_procedural_us: f32,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = bundled()?;
    let [mut blending, mut semi_procedural] =
        [Modes::Blending, Modes::SemiProcedural].map(|modes| Walkers::new(studio(db.clone(), modes)));
    (0..WARM_UP).for_each(|_| [&mut blending, &mut semi_procedural].into_iter().for_each(Walkers::step));
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
    let (goals, bars, text) = (goals(&details), bars(&details), text(&details));
    conclude(&Found { details, goals, bars }, &text, args.json)
}

impl Details {
    /// Medians over turns.
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

fn bars(details: &Details) -> Vec<Bar> {
    let bar = |name, measured: Option<f32>| Bar::at_most(name, OVER_PLAIN, measured.map(f64::from));
    vec![
        bar("blending over four rows and forward kinematics", details.blending_over_plain),
        bar("semi-procedural over four rows and forward kinematics", details.semi_procedural_over_plain),
    ]
}

impl Walkers {
    fn new(studio: SynthesisContext) -> Self {
        let mut random = SplitMix64::new(1, 0);
        let mut within = |range: f32| random.within(f64::from(range)) as f32;
        let bodies =
            (0..BODIES).map(|index| Body::standing(&studio, Root::default(), index as f32 / BODIES as f32).0).collect();
        let asked = (0..BODIES)
            .map(|_| {
                let velocity_mps = Vec2::new(SPEED_MPS[0] + within(SPEED_MPS[1]), within(STRAFE_MPS));
                (velocity_mps, within(TURN_RATE_RAD_S) * studio.params.turn_time_s)
            })
            .collect();
        Self { bodies, asked, studio }
    }

    fn step(&mut self) {
        let time_step = TimeStep::new(DT_S);
        for (body, &(velocity_mps, ahead_rad)) in self.bodies.iter_mut().zip(&self.asked) {
            let facing_rad = body.root.facing_rad + ahead_rad;
            let velocity_mps = Vec2::from_angle(facing_rad).rotate(velocity_mps);
            body.advance(&self.studio, &Plan { velocity_mps, facing_rad, ..Plan::default() }, &time_step);
            black_box(body.synthesize(&self.studio, &time_step));
        }
    }
}

/// The first four examples of each mix at the row before the phase, and forward kinematics.
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

/// Of [`STEPS`] steps of all bodies, per body and step.
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

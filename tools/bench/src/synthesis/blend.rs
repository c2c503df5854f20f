//! `fbcrowd bench blend`: whether a blending body does what it is commanded, all over the hull of the examples
//! (`FbCrowd` §5).
//!
//! A plan commands (v_f, ω_t, ω_s). Achieved are those of the synthesised root after the start of the body. The
//! commanded points lie on a grid over the box of the examples, and on the same grid scaled down towards standing; each
//! is moved to the nearest point that the database has. Commands slower than the smallest steps are not walked: the
//! body stands (`hms/gait.rs`). Such points are counted and have no criterion.
//!
//! The same roots show whether a straight walk stays straight, whether a circle closes, and whether the time step
//! matters: one sequence of commands must lead to the same positions with time steps of every length.

use std::f32::consts::{FRAC_PI_2, TAU};

use fbcrowd_jobs::Observer;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::command::START_IDLE_SHARE;
use fbcrowd_sim::synthesis::{Modes, SynthesisContext};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::Parameters;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::lone_body::{TIME_STEPS_S, achieved, commanded_roots, context, roots, turned_rad};
use crate::kit::report::{BenchReport, Criterion};

/// Grid points along each axis.
const GRID: usize = 9;
/// Scales of the grid, from the box of the examples towards standing.
const SCALES: [f32; 3] = [1.0, 0.5, 0.25];
/// Points nearer to each other than this are one, m/s and rad/s.
const SAME: f32 = 1e-3;
/// Duration of a start, s.
const STARTING_S: f32 = 6.0;
/// Duration of a measurement, s.
const MEASURED_S: f32 = 6.0;
/// Tolerance of the mean error.
const MEAN: Tolerance = Tolerance { share: 0.02, least: [0.02, 0.017_453, 0.02] };
/// Tolerance of the worst error.
const WORST: Tolerance = Tolerance { share: 0.05, least: [0.04, 0.052_36, 0.04] };
/// Length of a straight walk, m.
const STRAIGHT_M: f32 = 50.0;
/// Speeds of straight walks, m/s; those that the database lacks are left out.
const STRAIGHT_MPS: [f32; 4] = [0.5, 0.8, 1.2, 2.0];
/// Greatest distance from the straight line and from the start of a circle, cm: less than is visible.
const OFF_MAX_CM: f64 = 2.0;
/// Speeds and turn rates of circles, m/s and rad/s; those that the database lacks are left out.
const CIRCLES: [[f32; 2]; 4] = [[0.6, 0.5], [0.8, 0.8], [0.8, -0.8], [1.2, 0.6]];
/// Sum of the changes of velocity in the command sequence, m/s. A command takes effect at the start of a step, on
/// average half a step late, so roots may be apart by half a step times this.
const SEQUENCE_CHANGES_MPS: f32 = 6.2;

/// Measure whether blending bodies do what they are commanded, walk straight ahead, and close their circles.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench blend\n  fbcrowd bench blend --db motion.fbdb --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Measurements by time step.
    pub runs: Vec<TimeStepRun>,
}

/// Measurements with one time step.
#[derive(JsonSchema, Serialize)]
pub struct TimeStepRun {
    /// Time step, s.
    pub dt_s: f32,
    /// Commanded points.
    pub points: Vec<CommandedPoint>,
    /// Greatest distance from a straight line of 50 m, cm; null where the database has no straight walk.
    pub straight_cm: Option<f64>,
    /// Greatest distance from the start of a circle to its end, cm; null where the database has no circle.
    pub circle_cm: Option<f64>,
    /// Greatest distance from the roots with time steps of 1/120 s and the same commands, cm.
    pub apart_cm: f64,
}

/// One commanded point.
#[derive(JsonSchema, Serialize)]
pub struct CommandedPoint {
    /// Commanded v_f m/s, ω_t rad/s and ω_s m/s.
    #[serde(rename = "asked")]
    pub commanded: [f32; 3],
    /// Achieved v_f m/s, ω_t rad/s and ω_s m/s.
    pub achieved: [f32; 3],
    /// Share of standing in the blend, 0 to 1. From the share at which a body starts on, the point has no criterion.
    pub idle_share: f32,
}

/// Tolerance of an error: a share of the command, or the least values for v_f m/s, ω_t rad/s and ω_s m/s.
struct Tolerance {
    share: f32,
    least: [f32; 3],
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let context = context(database(&args.database)?, Modes::Blending);
    let commands = grid(&context);
    let finest = sequence_roots(&context, TIME_STEPS_S[0]);
    let measured = |dt_s: f32| TimeStepRun {
        dt_s,
        points: commands.iter().map(|&command| point(&context, command, dt_s)).collect(),
        straight_cm: straight_cm(&context, dt_s),
        circle_cm: circle_cm(&context, dt_s),
        apart_cm: apart_cm(&finest, &sequence_roots(&context, dt_s)),
    };
    let runs: Vec<TimeStepRun> = TIME_STEPS_S.map(measured).into();
    let criteria = runs.iter().flat_map(criteria).collect();
    let text = runs.iter().map(text).collect::<String>();
    Ok(BenchReport { details: Details { runs }, goals: Vec::new(), criteria, text })
}

/// The commanded points.
fn grid(context: &SynthesisContext) -> Vec<Parameters> {
    let corners = context.db.examples.iter().map(|example| example.parameters.to_vec3());
    let (least, most) = corners.fold((Vec3::ZERO, Vec3::ZERO), |(least, most), at| (least.min(at), most.max(at)));
    let mut points: Vec<Vec3> = Vec::new();
    for scale in SCALES {
        for index in 0..GRID.pow(3) {
            let at = [index % GRID, index / GRID % GRID, index / GRID.pow(2)].map(|k| k as f32 / (GRID - 1) as f32);
            let query = Parameters::from_vec3(scale * (least + (most - least) * Vec3::from(at)));
            let point = context.domain.reachable(query).parameters.to_vec3();
            if points.iter().all(|other| other.distance(point) > SAME) {
                points.push(point);
            }
        }
    }
    points.into_iter().map(Parameters::from_vec3).collect()
}

fn point(context: &SynthesisContext, commanded: Parameters, dt_s: f32) -> CommandedPoint {
    let achieved = achieved(&steady_roots(context, commanded, MEASURED_S, dt_s), dt_s);
    CommandedPoint {
        commanded: commanded.to_vec3().to_array(),
        achieved: achieved.to_vec3().to_array(),
        idle_share: context.domain.reachable(commanded).idle_share,
    }
}

/// Roots of a body with a constant command, after the start.
fn steady_roots(context: &SynthesisContext, command: Parameters, seconds: f32, dt_s: f32) -> Vec<Root> {
    let mut roots = commanded_roots(context, STARTING_S + seconds, dt_s, |_| command);
    roots.split_off((STARTING_S / dt_s).round() as usize)
}

/// The commands that the database has motions for.
fn available(
    context: &SynthesisContext,
    commands: impl Iterator<Item = Parameters>,
) -> impl Iterator<Item = Parameters> {
    let nearest = |command: &Parameters| context.domain.reachable(*command).parameters.to_vec3();
    commands.filter(move |command| nearest(command).distance(command.to_vec3()) < SAME)
}

/// Greatest distance from the line along the first facing, over [`STRAIGHT_M`], cm.
fn straight_cm(context: &SynthesisContext, dt_s: f32) -> Option<f64> {
    let walks = STRAIGHT_MPS.map(|speed_mps| Parameters { speed_mps, ..Parameters::default() });
    let furthest_cm = |walk: Parameters| {
        let roots = steady_roots(context, walk, STRAIGHT_M / walk.speed_mps, dt_s);
        let off_m = |root: &Root| roots[0].forward().perp_dot(root.position_m - roots[0].position_m).abs();
        100.0 * f64::from(roots.iter().map(off_m).fold(0.0, f32::max))
    };
    available(context, walks.into_iter()).map(furthest_cm).reduce(f64::max)
}

/// Greatest distance from the start of a circle to its end after 360°, cm.
fn circle_cm(context: &SynthesisContext, dt_s: f32) -> Option<f64> {
    let circles =
        CIRCLES.map(|[speed_mps, turn_rate_rad_s]| Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 });
    let off_cm = |circle: Parameters| {
        let roots = steady_roots(context, circle, TAU / circle.turn_rate_rad_s.abs() + 0.5, dt_s);
        100.0 * f64::from(closed_m(&roots).distance(roots[0].position_m))
    };
    available(context, circles.into_iter()).map(off_cm).reduce(f64::max)
}

/// Position at which a root has turned by 360°, interpolated between two steps, m.
fn closed_m(roots: &[Root]) -> Vec2 {
    let mut turned = 0.0;
    for pair in roots.windows(2) {
        let step_rad = turned_rad(&pair[0], &pair[1]).abs();
        if turned + step_rad >= TAU {
            return pair[0].position_m.lerp(pair[1].position_m, (TAU - turned) / step_rad);
        }
        turned += step_rad;
    }
    roots[roots.len() - 1].position_m
}

/// Commands that change at whole tenths of seconds: start, curve, dodge, slow down, stop, start again.
fn command_sequence(time_s: f32) -> Plan {
    let towards = |angle_rad: f32, speed_mps: f32| Plan {
        velocity_mps: Vec2::from_angle(angle_rad) * speed_mps,
        facing_rad: angle_rad,
        time_to_collision_s: f32::INFINITY,
        ..Plan::default()
    };
    match time_s {
        t if t < 0.5 => towards(0.0, 0.0),
        t if t < 3.0 => towards(0.0, 1.2),
        t if t < 5.0 => towards(FRAC_PI_2, 1.0),
        t if t < 7.0 => Plan { velocity_mps: Vec2::new(-0.25, 0.9), ..towards(FRAC_PI_2, 0.0) },
        t if t < 9.0 => towards(FRAC_PI_2, 0.6),
        t if t < 11.0 => towards(FRAC_PI_2, 0.0),
        t if t < 13.0 => towards(0.5, 1.1),
        _ => towards(0.5, 0.0),
    }
}

/// Roots of a body that follows the command sequence, every tenth of a second.
fn sequence_roots(context: &SynthesisContext, dt_s: f32) -> Vec<Root> {
    // The middle of a step decides which command is active: its start may be rounded to either side.
    let roots = roots(context, 15.0, dt_s, |time_s, _| command_sequence(time_s + 0.5 * dt_s));
    roots.into_iter().step_by((0.1 / dt_s).round() as usize).collect()
}

/// Greatest distance of two roots at one time, cm.
fn apart_cm(one: &[Root], other: &[Root]) -> f64 {
    let apart_m = one.iter().zip(other).map(|(one, other)| one.position_m.distance(other.position_m));
    100.0 * f64::from(apart_m.fold(0.0, f32::max))
}

impl CommandedPoint {
    /// Whether the body walks: with a greater share of standing it stands.
    fn is_walked(&self) -> bool {
        self.idle_share < START_IDLE_SHARE
    }

    /// Error divided by its tolerance, on one axis.
    fn excess(&self, axis: usize, tolerance: &Tolerance) -> f64 {
        let tolerance = (tolerance.share * self.commanded[axis].abs()).max(tolerance.least[axis]);
        f64::from((self.achieved[axis] - self.commanded[axis]).abs() / tolerance)
    }
}

/// Mean and worst error divided by the tolerance, on one axis.
fn excesses(run: &TimeStepRun, axis: usize) -> [Option<f64>; 2] {
    let walked = || run.points.iter().filter(|point| point.is_walked());
    let sum = walked().map(|point| point.excess(axis, &MEAN)).reduce(|sum, excess| sum + excess);
    let mean = sum.map(|sum| sum / walked().count() as f64);
    [mean, walked().map(|point| point.excess(axis, &WORST)).reduce(f64::max)]
}

fn criteria(run: &TimeStepRun) -> Vec<Criterion> {
    let at = format!("in steps of {:.4} s", run.dt_s);
    let mut criteria = Vec::new();
    for (axis, name) in ["v_f", "ω_t", "ω_s"].into_iter().enumerate() {
        let [mean, worst] = excesses(run, axis);
        criteria.push(Criterion::at_most(format!("mean error of {name} over its tolerance, {at}"), 1.0, mean));
        criteria.push(Criterion::at_most(format!("worst error of {name} over its tolerance, {at}"), 1.0, worst));
    }
    criteria.push(Criterion::at_most(format!("off a straight line of 50 m {at}, cm"), OFF_MAX_CM, run.straight_cm));
    criteria.push(Criterion::at_most(format!("off the start of a circle {at}, cm"), OFF_MAX_CM, run.circle_cm));
    if run.dt_s > TIME_STEPS_S[0] {
        let limit_cm = f64::from(100.0 * SEQUENCE_CHANGES_MPS * 0.5 * run.dt_s);
        criteria.push(Criterion::at_most(
            format!("apart from the root in steps of 1/120 s {at}, cm"),
            limit_cm,
            run.apart_cm,
        ));
    }
    criteria
}

fn text(run: &TimeStepRun) -> String {
    let walked = run.points.iter().filter(|point| point.is_walked()).count();
    let slowest = run.points.iter().filter(|point| !point.is_walked());
    let standing = slowest.map(|point| Vec2::new(point.commanded[0], point.commanded[2]).length()).fold(0.0, f32::max);
    format!(
        "steps of {:.4} s: {walked} points commanded and walked, {} so slow that the body stands (up to {standing:.2} m/s)\n",
        run.dt_s,
        run.points.len() - walked
    )
}

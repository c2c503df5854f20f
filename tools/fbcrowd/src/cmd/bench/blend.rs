//! `fbcrowd bench blend`: does a blending body do what is asked, all over the hull of the examples (`FbCrowd` §5)?
//!
//! A plan asks for (v_f, ω_t, ω_s); achieved are those of the synthesised root, once the body has started. The points
//! asked lie on a grid over the box of the examples, and on the same grid drawn in towards standing, each taken to the
//! nearest point that the database has. What is slower than the least steps is not walked: the body stands
//! (`hms/gait.rs`), and such points are counted, not judged.
//!
//! The same roots tell whether a straight walk stays straight, whether a circle closes, and whether the step of time
//! matters: one sequence of commands, walked in steps of every length, must lead to the same places.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::path::PathBuf;

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::command::START_IDLE_SHARE;
use fbcrowd_sim::synthesis::{Modes, SynthesisContext};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::Parameters;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::walker::{DT_S, achieved, asked_roots, roots, studio, turned_rad};
use crate::failure::{Answer, Failure};

/// Grid points along each axis, and how far the grid is drawn in.
const GRID: usize = 9;
const DRAWN_IN: [f32; 3] = [1.0, 0.5, 0.25];
/// Grid points nearer to each other than this are one, m/s and rad/s.
const SAME: f32 = 1e-3;
/// A body gets this long to start, and is then watched for that long, s.
const STARTING_S: f32 = 6.0;
const WATCHED_S: f32 = 6.0;
/// Allowed in the mean and at the worst: a share of what is asked, or this much, m/s, rad/s, m/s.
const MEAN: Allowed = Allowed { share: 0.02, least: [0.02, 0.017_453, 0.02] };
const WORST: Allowed = Allowed { share: 0.05, least: [0.04, 0.052_36, 0.04] };
/// A straight walk is this long, at each of these speeds, where the database has them.
const STRAIGHT_M: f32 = 50.0;
const STRAIGHT_MPS: [f32; 4] = [0.5, 0.8, 1.2, 2.0];
/// Off the straight line, and off the start of a circle, cm: less than is seen.
const OFF_MAX_CM: f64 = 2.0;
/// Circles are walked at each of these speeds and turn rates, where the database has them, m/s and rad/s.
const CIRCLES: [[f32; 2]; 4] = [[0.6, 0.5], [0.8, 0.8], [0.8, -0.8], [1.2, 0.6]];
/// A command is heard at the beginning of a step, on average half a step late: the changes of velocity on the errand
/// add up to this, m/s, and times half a step of time to what roots may be apart.
const ERRAND_CHANGES_MPS: f32 = 6.2;

/// Measure whether blending bodies do what is asked, walk straight ahead, and close their circles.
///
/// In JSON `runs[] {dt_s, points[] {asked[3], achieved[3], idle_share}, straight_cm, circle_cm, apart_cm}`: v_f in m/s,
/// ω_t in rad/s, ω_s in m/s; how far off a straight line of 50 m and the start of a circle; how far from the roots that
/// walk by the same commands in steps of 1/120 s. Points of which standing has a greater share than a body starts at
/// are listed, not judged.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench blend\n  fbcrowd bench blend --db motion.fbdb --json")]
pub(super) struct Args {
    /// The database; that of the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    runs: Vec<Run>,
}

/// Everything in steps of one length.
#[derive(Serialize)]
struct Run {
    dt_s: f32,
    points: Vec<Point>,
    straight_cm: Option<f64>,
    circle_cm: Option<f64>,
    apart_cm: f64,
}

#[derive(Serialize)]
struct Point {
    asked: [f32; 3],
    achieved: [f32; 3],
    idle_share: f32,
}

/// An error that is allowed.
struct Allowed {
    share: f32,
    least: [f32; 3],
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let studio = studio(database(args.database.as_deref())?, Modes::Blending);
    let asked = grid(&studio);
    let finest = errand_roots(&studio, DT_S[0]);
    let measured = |dt_s: f32| Run {
        dt_s,
        points: asked.iter().map(|&asked| point(&studio, asked, dt_s)).collect(),
        straight_cm: straight_cm(&studio, dt_s),
        circle_cm: circle_cm(&studio, dt_s),
        apart_cm: apart_cm(&finest, &errand_roots(&studio, dt_s)),
    };
    let runs = DT_S.map(measured);
    let bars = runs.iter().flat_map(bars).collect();
    let text = runs.iter().map(text).collect::<String>();
    conclude(&Found { details: Details { runs: runs.into() }, goals: Vec::new(), bars }, &text, args.json)
}

/// The points asked.
fn grid(studio: &SynthesisContext) -> Vec<Parameters> {
    let corners = studio.db.examples.iter().map(|example| example.parameters.to_vec3());
    let (least, most) = corners.fold((Vec3::ZERO, Vec3::ZERO), |(least, most), at| (least.min(at), most.max(at)));
    let mut points: Vec<Vec3> = Vec::new();
    for drawn_in in DRAWN_IN {
        for index in 0..GRID.pow(3) {
            let at = [index % GRID, index / GRID % GRID, index / GRID.pow(2)].map(|k| k as f32 / (GRID - 1) as f32);
            let query = Parameters::from_vec3(drawn_in * (least + (most - least) * Vec3::from(at)));
            let point = studio.domain.reachable(query).parameters.to_vec3();
            if points.iter().all(|other| other.distance(point) > SAME) {
                points.push(point);
            }
        }
    }
    points.into_iter().map(Parameters::from_vec3).collect()
}

fn point(studio: &SynthesisContext, asked: Parameters, dt_s: f32) -> Point {
    let roots = asked_roots(studio, STARTING_S + WATCHED_S, dt_s, |_| asked);
    let achieved = achieved(&roots[(STARTING_S / dt_s).round() as usize..], dt_s);
    Point {
        asked: asked.to_vec3().to_array(),
        achieved: achieved.to_vec3().to_array(),
        idle_share: studio.domain.reachable(asked).idle_share,
    }
}

/// Roots that walk as is asked of them, after the start.
fn started(studio: &SynthesisContext, asked: Parameters, seconds: f32, dt_s: f32) -> Vec<Root> {
    let mut roots = asked_roots(studio, STARTING_S + seconds, dt_s, |_| asked);
    roots.split_off((STARTING_S / dt_s).round() as usize)
}

/// Those of some ways to walk that the database has.
fn had(studio: &SynthesisContext, ways: impl Iterator<Item = Parameters>) -> impl Iterator<Item = Parameters> {
    ways.filter(|way| studio.domain.reachable(*way).parameters.to_vec3().distance(way.to_vec3()) < SAME)
}

/// Furthest off the line along which the body faced, over [`STRAIGHT_M`].
fn straight_cm(studio: &SynthesisContext, dt_s: f32) -> Option<f64> {
    let ways = STRAIGHT_MPS.map(|speed_mps| Parameters { speed_mps, ..Parameters::default() });
    let furthest_cm = |way: Parameters| {
        let roots = started(studio, way, STRAIGHT_M / way.speed_mps, dt_s);
        let off_m = |root: &Root| roots[0].forward().perp_dot(root.position_m - roots[0].position_m).abs();
        100.0 * f64::from(roots.iter().map(off_m).fold(0.0, f32::max))
    };
    had(studio, ways.into_iter()).map(furthest_cm).reduce(f64::max)
}

/// Furthest from where a circle began, once it has turned by 360°.
fn circle_cm(studio: &SynthesisContext, dt_s: f32) -> Option<f64> {
    let way = |[speed_mps, turn_rate_rad_s]: [f32; 2]| Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
    let off_cm = |way: Parameters| {
        let roots = started(studio, way, TAU / way.turn_rate_rad_s.abs() + 0.5, dt_s);
        100.0 * f64::from(closed_m(&roots).distance(roots[0].position_m))
    };
    had(studio, CIRCLES.map(way).into_iter()).map(off_cm).reduce(f64::max)
}

/// Where a root is when it has turned once, between two steps.
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

/// Commands in the world that change at whole tenths of seconds: start, curve, dodge aside, slow down, stop, start
/// anew.
fn errand(time_s: f32) -> Plan {
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

/// Where the errand leads, every tenth of a second.
fn errand_roots(studio: &SynthesisContext, dt_s: f32) -> Vec<Root> {
    // The middle of a step tells what is in force, whatever rounding makes of its beginning.
    let roots = roots(studio, 15.0, dt_s, |time_s, _| errand(time_s + 0.5 * dt_s));
    roots.into_iter().step_by((0.1 / dt_s).round() as usize).collect()
}

fn apart_cm(one: &[Root], other: &[Root]) -> f64 {
    let apart_m = one.iter().zip(other).map(|(one, other)| one.position_m.distance(other.position_m));
    100.0 * f64::from(apart_m.fold(0.0, f32::max))
}

impl Point {
    fn is_walked(&self) -> bool {
        self.idle_share < START_IDLE_SHARE
    }

    /// Error over what is allowed, on one axis.
    fn excess(&self, axis: usize, allowed: &Allowed) -> f64 {
        let allowed = (allowed.share * self.asked[axis].abs()).max(allowed.least[axis]);
        f64::from((self.achieved[axis] - self.asked[axis]).abs() / allowed)
    }
}

/// Mean and worst error over what is allowed, on one axis.
fn excesses(run: &Run, axis: usize) -> [Option<f64>; 2] {
    let walked = || run.points.iter().filter(|point| point.is_walked());
    let sum = walked().map(|point| point.excess(axis, &MEAN)).reduce(|sum, excess| sum + excess);
    let mean = sum.map(|sum| sum / walked().count() as f64);
    [mean, walked().map(|point| point.excess(axis, &WORST)).reduce(f64::max)]
}

fn bars(run: &Run) -> Vec<Bar> {
    let at = format!("in steps of {:.4} s", run.dt_s);
    let mut bars = Vec::new();
    for (axis, name) in ["v_f", "ω_t", "ω_s"].into_iter().enumerate() {
        let [mean, worst] = excesses(run, axis);
        bars.push(Bar::at_most(format!("mean error of {name} over what is allowed, {at}"), 1.0, mean));
        bars.push(Bar::at_most(format!("worst error of {name} over what is allowed, {at}"), 1.0, worst));
    }
    bars.push(Bar::at_most(format!("off a straight line of 50 m {at}, cm"), OFF_MAX_CM, run.straight_cm));
    bars.push(Bar::at_most(format!("off the start of a circle {at}, cm"), OFF_MAX_CM, run.circle_cm));
    if run.dt_s > DT_S[0] {
        let limit_cm = f64::from(100.0 * ERRAND_CHANGES_MPS * 0.5 * run.dt_s);
        bars.push(Bar::at_most(format!("apart from the root in steps of 1/120 s {at}, cm"), limit_cm, run.apart_cm));
    }
    bars
}

fn text(run: &Run) -> String {
    let walked = run.points.iter().filter(|point| point.is_walked()).count();
    let slowest = run.points.iter().filter(|point| !point.is_walked());
    let standing = slowest.map(|point| Vec2::new(point.asked[0], point.asked[2]).length()).fold(0.0, f32::max);
    format!(
        "steps of {:.4} s: {walked} points asked and walked, {} so slow that the body stands (up to {standing:.2} m/s)\n",
        run.dt_s,
        run.points.len() - walked
    )
}

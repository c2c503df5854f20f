//! `fbcrowd bench tracking`: how closely a root follows its commands (`FbCrowd` §5).
//!
//! Commands accelerate by no more than [`ACCELERATION_MPS2`]. Semi-procedural locomotion follows world velocities; its
//! measure is the distance after one step between the root and the position to which the command leads from the last
//! root. Blending follows (v_f, ω_t, ω_s) that change from one steady gait to another; its measure is the distance to a
//! root that did exactly what it was commanded, one cycle after the command is steady again. Each command comes at
//! eight times of the stride, of which the worst counts. Starts, and stops, for which a body finishes its step, have
//! criteria of their own: standing bodies are blended with every synthesis.

use std::f32::consts::{FRAC_PI_2, PI};

use fbcrowd_jobs::Observer;
use fbcrowd_sim::maths::moved_root;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::{Modes, SynthesisContext};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::Parameters;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::lone_body::{TIME_STEPS_S, commanded_roots, context, roots};
use crate::kit::report::{BenchReport, Criterion};
use crate::synthesis::sequence_walk::{APART_S, BODIES};

/// Greatest change of a commanded velocity, m/s², and of a commanded turn rate, rad/s².
const ACCELERATION_MPS2: f32 = 2.5;
/// Greatest distance of semi-procedural locomotion from its command after one step, cm.
const STEP_MAX_CM: f64 = 1.0;
/// Greatest distance of blending from its command after one cycle, cm.
const BEHIND_MAX_CM: f64 = 5.0;
/// Duration of the walk before a command changes, s.
const CHANGE_S: f32 = 4.0;
/// Duration of the measurement after that, s.
const MEASURED_S: f32 = 3.0;

/// Steady gaits (v_f m/s, ω_t rad/s, ω_s m/s), from each of which a blending body changes to each other one.
const GAITS: [(&str, [f32; 3]); 13] = [
    ("stand", [0.0, 0.0, 0.0]),
    ("slow", [0.8, 0.0, 0.0]),
    ("walk", [1.1, 0.0, 0.0]),
    ("fast", [1.4, 0.0, 0.0]),
    ("curve left", [0.8, 0.5, 0.0]),
    ("curve right", [0.8, -0.5, 0.0]),
    ("veer left", [0.8, 0.0, 0.2]),
    ("veer right", [0.8, 0.0, -0.2]),
    ("step left", [0.0, 0.0, 0.3]),
    ("step right", [0.0, 0.0, -0.3]),
    ("step back", [-0.5, 0.0, 0.0]),
    ("turn left", [0.0, 1.5, 0.0]),
    ("turn right", [0.0, -1.5, 0.0]),
];

/// A world velocity, m/s, and a facing, rad, by the time since the command changes, s; before that, those of time 0.
type Command = fn(f32) -> (Vec2, f32);
/// Commands for semi-procedural locomotion, by name.
const COMMANDS: [(&str, Command); 17] = [
    ("start", |time_s| (ramp(time_s, Vec2::ZERO, Vec2::new(1.2, 0.0)), 0.0)),
    ("start to the left", |time_s| (ramp(time_s, Vec2::ZERO, Vec2::new(0.0, 0.4)), 0.0)),
    ("start to the right", |time_s| (ramp(time_s, Vec2::ZERO, Vec2::new(0.0, -0.4)), 0.0)),
    ("start backward", |time_s| (ramp(time_s, Vec2::ZERO, Vec2::new(-0.5, 0.0)), 0.0)),
    ("turn on the spot", |time_s| (Vec2::ZERO, (1.5 * time_s).clamp(0.0, PI))),
    ("speed up", |time_s| (ramp(time_s, Vec2::new(0.8, 0.0), Vec2::new(1.4, 0.0)), 0.0)),
    ("slow down", |time_s| (ramp(time_s, Vec2::new(1.4, 0.0), Vec2::new(0.7, 0.0)), 0.0)),
    ("stop", |time_s| (ramp(time_s, Vec2::new(1.2, 0.0), Vec2::ZERO), 0.0)),
    ("dodge left", |time_s| (ramp(time_s, Vec2::new(1.0, 0.0), Vec2::new(1.0, 0.4)), 0.0)),
    ("dodge right", |time_s| (ramp(time_s, Vec2::new(1.0, 0.0), Vec2::new(1.0, -0.4)), 0.0)),
    ("step left", |time_s| (ramp(time_s, Vec2::new(0.6, 0.0), Vec2::new(0.0, 0.4)), 0.0)),
    ("step right", |time_s| (ramp(time_s, Vec2::new(0.6, 0.0), Vec2::new(0.0, -0.4)), 0.0)),
    ("step back", |time_s| (ramp(time_s, Vec2::new(0.6, 0.0), Vec2::new(-0.5, 0.0)), 0.0)),
    ("wide curve left", |time_s| curve(time_s, 1.2, 0.8)),
    ("wide curve right", |time_s| curve(time_s, 1.2, -0.8)),
    ("tight curve left", |time_s| curve(time_s, 1.2, ACCELERATION_MPS2 / 1.2)),
    ("tight curve right", |time_s| curve(time_s, 1.2, -ACCELERATION_MPS2 / 1.2)),
];

/// Measure how closely roots follow their commands.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench tracking\n  fbcrowd bench tracking --db motion.fbdb --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Commands to semi-procedural locomotion.
    #[serde(rename = "steps")]
    pub commands: Vec<TrackedCommand>,
    /// Changes from one steady gait to another by blending.
    pub changes: Vec<GaitChange>,
}

/// A command to semi-procedural locomotion.
#[derive(JsonSchema, Serialize)]
pub struct TrackedCommand {
    /// Time step, s.
    pub dt_s: f32,
    /// Name of the command.
    pub command: &'static str,
    /// Greatest distance from the command after one step, of eight times of the stride, cm.
    pub worst_cm: f64,
    #[serde(skip)]
    standing: Standing,
}

/// A change from one steady gait to another by blending.
#[derive(JsonSchema, Serialize)]
pub struct GaitChange {
    /// Time step, s.
    pub dt_s: f32,
    /// Gait before the change: v_f m/s, ω_t rad/s and ω_s m/s.
    pub from: [f32; 3],
    /// Gait after the change: v_f m/s, ω_t rad/s and ω_s m/s.
    pub to: [f32; 3],
    /// Greatest distance from the command one cycle after the change, of eight times of the stride, cm.
    pub behind_cm: f64,
}

/// Whether a command starts or ends with standing.
#[derive(Clone, Copy, PartialEq)]
enum Standing {
    Never,
    AtFirst,
    AtLast,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = database(&args.database)?;
    let semi_procedural = context(db.clone(), Modes::SemiProcedural);
    let blending = context(db, Modes::Blending);
    let gaits = available_gaits(&blending);
    let (mut commands, mut changes): (Vec<TrackedCommand>, Vec<GaitChange>) = (Vec::new(), Vec::new());
    for dt_s in TIME_STEPS_S {
        let tracked =
            COMMANDS.into_par_iter().map(|(name, command)| tracked_command(&semi_procedural, name, command, dt_s));
        commands.par_extend(tracked);
        changes.par_extend(pairs(&gaits).into_par_iter().map(|(from, to)| gait_change(&blending, from, to, dt_s)));
    }
    let criteria = TIME_STEPS_S.iter().flat_map(|&dt_s| criteria(&commands, &changes, dt_s)).collect();
    let details = Details { commands, changes };
    Ok(BenchReport { text: text(&details, &gaits), details, goals: Vec::new(), criteria })
}

/// A velocity that changes to another one at the greatest acceleration, m/s.
fn ramp(time_s: f32, from: Vec2, to: Vec2) -> Vec2 {
    from.move_towards(to, ACCELERATION_MPS2 * time_s.max(0.0))
}

/// The velocity, m/s, and the facing, rad, along a curve by 90°.
fn curve(time_s: f32, speed_mps: f32, turn_rate_rad_s: f32) -> (Vec2, f32) {
    let angle_rad = (turn_rate_rad_s * time_s.max(0.0)).clamp(-FRAC_PI_2, FRAC_PI_2);
    (Vec2::from_angle(angle_rad) * speed_mps, angle_rad)
}

/// Times at which commands change, s: a part of a stride apart.
fn change_times_s() -> impl Iterator<Item = f32> {
    (0..BODIES).map(|index| CHANGE_S + APART_S * index as f32)
}

fn tracked_command(context: &SynthesisContext, name: &'static str, command: Command, dt_s: f32) -> TrackedCommand {
    let worst_m = change_times_s().map(|change_s| worst_step_m(context, command, change_s, dt_s)).fold(0.0, f32::max);
    let standing = match (command(0.0).0, command(MEASURED_S).0) {
        (Vec2::ZERO, _) => Standing::AtFirst,
        (_, Vec2::ZERO) => Standing::AtLast,
        _ => Standing::Never,
    };
    TrackedCommand { dt_s, command: name, worst_cm: 100.0 * f64::from(worst_m), standing }
}

/// Greatest distance from the command after a step, from the change of the command on, m.
fn worst_step_m(context: &SynthesisContext, command: Command, change_s: f32, dt_s: f32) -> f32 {
    // The command of a step is that of its middle.
    let at = |step: usize| command((step as f32 + 0.5) * dt_s - change_s);
    let plan = |time_s: f32, _: &Root| {
        let (velocity_mps, facing_rad) = at((time_s / dt_s).round() as usize);
        Plan { velocity_mps, facing_rad, time_to_collision_s: f32::INFINITY, ..Plan::default() }
    };
    let roots = roots(context, change_s + MEASURED_S, dt_s, plan);
    let off_m = |(step, pair): (usize, &[Root])| {
        let moved_m = pair[1].position_m - pair[0].position_m;
        moved_m.distance(at(step).0 * dt_s)
    };
    roots.windows(2).enumerate().skip((change_s / dt_s).round() as usize).map(off_m).fold(0.0, f32::max)
}

/// The gaits that the database has.
fn available_gaits(context: &SynthesisContext) -> Vec<(&'static str, Vec3)> {
    let is_available =
        |gait: Vec3| context.domain.reachable(Parameters::from_vec3(gait)).parameters.to_vec3().distance(gait) < 1e-3;
    let gaits = GAITS.into_iter().map(|(name, gait)| (name, Vec3::from(gait)));
    gaits.filter(|&(_, gait)| is_available(gait)).collect()
}

/// Each gait with each other one.
fn pairs(gaits: &[(&str, Vec3)]) -> Vec<(Vec3, Vec3)> {
    let pairs = gaits.iter().flat_map(|&(_, from)| gaits.iter().map(move |&(_, to)| (from, to)));
    pairs.filter(|(from, to)| from != to).collect()
}

fn gait_change(context: &SynthesisContext, from: Vec3, to: Vec3, dt_s: f32) -> GaitChange {
    let behind_m = change_times_s().map(|change_s| behind_m(context, from, to, change_s, dt_s)).fold(0.0, f32::max);
    GaitChange { dt_s, from: from.to_array(), to: to.to_array(), behind_cm: 100.0 * f64::from(behind_m) }
}

/// Distance of the root from the command, one cycle after the command is steady again, m.
fn behind_m(context: &SynthesisContext, from: Vec3, to: Vec3, change_s: f32, dt_s: f32) -> f32 {
    let steady_s = (to - from).length() / ACCELERATION_MPS2;
    let command = |time_s: f32| {
        let done = ((time_s - change_s) / steady_s).clamp(0.0, 1.0);
        Parameters::from_vec3(from.lerp(to, done))
    };
    let middle = |time_s: f32| command(time_s + 0.5 * dt_s);
    let seconds = change_s + steady_s + cycle_s(context, to);
    let roots = commanded_roots(context, seconds, dt_s, middle);
    let changed = (change_s / dt_s).round() as usize;
    let commanded = (changed..roots.len() - 1)
        .fold(roots[changed], |root, step| moved_root(&root, &middle(step as f32 * dt_s), dt_s));
    roots[roots.len() - 1].position_m.distance(commanded.position_m)
}

/// Duration of a gait's cycle, s.
fn cycle_s(context: &SynthesisContext, gait: Vec3) -> f32 {
    let shares = context.domain.locate(Parameters::from_vec3(gait));
    let rates = shares.examples.iter().zip(shares.shares);
    1.0 / rates.map(|(&example, share)| share / context.db.examples[example as usize].phase_map.period_s).sum::<f32>()
}

fn criteria(commands: &[TrackedCommand], changes: &[GaitChange], dt_s: f32) -> Vec<Criterion> {
    let by_standing = [(Standing::Never, "change"), (Standing::AtFirst, "start"), (Standing::AtLast, "stop")];
    let criteria = by_standing.map(|(standing, word)| {
        let commands = commands.iter().filter(|command| command.dt_s == dt_s && command.standing == standing);
        let changes = changes.iter().filter(|change| change.dt_s == dt_s && change.standing() == standing);
        [
            Criterion::at_most(
                format!("semi-procedural, worst step of {dt_s:.4} s off its command in a {word}, cm"),
                STEP_MAX_CM,
                commands.map(|command| command.worst_cm).reduce(f64::max),
            ),
            Criterion::at_most(
                format!("blending in steps of {dt_s:.4} s, behind one cycle after a {word}, cm"),
                BEHIND_MAX_CM,
                changes.map(|change| change.behind_cm).reduce(f64::max),
            ),
        ]
    });
    criteria.into_iter().flatten().collect()
}

impl GaitChange {
    fn standing(&self) -> Standing {
        match [self.from, self.to].map(|gait| gait == [0.0; 3]) {
            [true, _] => Standing::AtFirst,
            [_, true] => Standing::AtLast,
            _ => Standing::Never,
        }
    }
}

/// A line for each command; then for each time step a row for each gait before, a column for each gait after a change.
fn text(details: &Details, gaits: &[(&'static str, Vec3)]) -> String {
    let mut text = "semi-procedural, worst step off its command, cm, in steps of 1/120, 1/30 and 0.1 s\n".to_owned();
    for (name, _) in COMMANDS {
        let worst = details.commands.iter().filter(|command| command.command == name);
        let worst: String = worst.map(|command| format!("{:8.2}", command.worst_cm)).collect();
        text += &format!("{name:>24}{worst}\n");
    }
    for dt_s in TIME_STEPS_S {
        text += &format!("blending in steps of {dt_s:.4} s, behind after one cycle, cm: from row to column\n");
        text += &format!("{:12}{}\n", "", gaits.iter().map(|(name, _)| format!("{name:>12}")).collect::<String>());
        for &(name, from) in gaits {
            let cells = gaits.iter().map(|&(_, to)| format!("{:>12}", details.cell(from, to, dt_s)));
            text += &format!("{name:>12}{}\n", cells.collect::<String>());
        }
    }
    text
}

impl Details {
    /// A cell of the table of changes; empty on the diagonal.
    fn cell(&self, from: Vec3, to: Vec3, dt_s: f32) -> String {
        let is_it = |change: &&GaitChange| change.dt_s == dt_s && (change.from, change.to) == (from.into(), to.into());
        self.changes.iter().find(is_it).map_or_else(String::new, |change| format!("{:.2}", change.behind_cm))
    }
}

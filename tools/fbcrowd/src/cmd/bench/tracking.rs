//! `fbcrowd bench tracking`: how closely does a root follow its commands (`FbCrowd` §5)?
//!
//! Commands accelerate by no more than [`ACCELERATION_MPS2`]. Semi-procedural locomotion is given velocities in the
//! world, and judged by each step: how far the root is from where the command would have brought it from its last
//! place. Blending is given (v_f, ω_t, ω_s), a change from one steady way to walk to another, and judged by how far its
//! root has then fallen behind one that did exactly as told, a cycle after the command has become steady. Each command
//! comes at eight moments of the stride, of which the worst counts. Starts, and stops, for which a body finishes its
//! step, have bars of their own: standing bodies are blended, whatever the synthesis.

use std::f32::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;

use fbcrowd_sim::maths::moved_root;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::{Modes, SynthesisContext};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::Parameters;
use rayon::prelude::*;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::quality_walk::{APART_S, BODIES};
use crate::cmd::bench::walker::{DT_S, asked_roots, roots, studio};
use crate::failure::{Answer, Failure};

/// Commands change by this at most, m/s², and turn rates by as much in rad/s².
const ACCELERATION_MPS2: f32 = 2.5;
/// The bars, cm: semi-procedural each step, blending after one cycle.
const STEP_MAX_CM: f64 = 1.0;
const BEHIND_MAX_CM: f64 = 5.0;
/// Commands change when the body has walked for so long, and are watched for as long, s.
const CHANGE_S: f32 = 4.0;
const WATCHED_S: f32 = 3.0;

/// Ways to walk, (v_f, ω_t, ω_s), of which a blending body changes from one to another.
const WAYS: [(&str, [f32; 3]); 13] = [
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

/// A velocity in the world and a facing, by the time since the command changed, s; before, what it is at 0.
type Command = fn(f32) -> (Vec2, f32);
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
///
/// In JSON `steps[] {dt_s, command, worst_cm}` of semi-procedural locomotion and `changes[] {dt_s, from[3], to[3],
/// behind_cm}` of blending, (v_f, ω_t, ω_s) in m/s and rad/s, each the worst of eight moments of the stride.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench tracking\n  fbcrowd bench tracking --db motion.fbdb --json")]
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
    steps: Vec<Step>,
    changes: Vec<Change>,
}

/// A command to semi-procedural locomotion.
#[derive(Serialize)]
struct Step {
    dt_s: f32,
    command: &'static str,
    worst_cm: f64,
    #[serde(skip)]
    stands: Stands,
}

/// A change of what is asked of blending.
#[derive(Serialize)]
struct Change {
    dt_s: f32,
    from: [f32; 3],
    to: [f32; 3],
    behind_cm: f64,
}

/// Where a command leads from or to standing.
#[derive(Clone, Copy, PartialEq)]
enum Stands {
    Never,
    AtFirst,
    AtLast,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = database(args.database.as_deref())?;
    let exact = studio(db.clone(), Modes::SemiProcedural);
    let blending = studio(db, Modes::Blending);
    let ways = ways(&blending);
    let (mut steps, mut changes): (Vec<Step>, Vec<Change>) = (Vec::new(), Vec::new());
    for dt_s in DT_S {
        steps.par_extend(COMMANDS.into_par_iter().map(|(name, command)| step(&exact, name, command, dt_s)));
        changes.par_extend(pairs(&ways).into_par_iter().map(|(from, to)| change(&blending, from, to, dt_s)));
    }
    let bars = DT_S.iter().flat_map(|&dt_s| bars(&steps, &changes, dt_s)).collect();
    let details = Details { steps, changes };
    let text = text(&details, &ways);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

/// From one velocity straight to another at the greatest acceleration.
fn ramp(time_s: f32, from: Vec2, to: Vec2) -> Vec2 {
    from.move_towards(to, ACCELERATION_MPS2 * time_s.max(0.0))
}

/// A right angle, the facing along the velocity.
fn curve(time_s: f32, speed_mps: f32, turn_rate_rad_s: f32) -> (Vec2, f32) {
    let angle_rad = (turn_rate_rad_s * time_s.max(0.0)).clamp(-FRAC_PI_2, FRAC_PI_2);
    (Vec2::from_angle(angle_rad) * speed_mps, angle_rad)
}

/// Moments at which commands change: a part of a stride later each, s.
fn moments_s() -> impl Iterator<Item = f32> {
    (0..BODIES).map(|index| CHANGE_S + APART_S * index as f32)
}

fn step(studio: &SynthesisContext, name: &'static str, command: Command, dt_s: f32) -> Step {
    let worst_m = moments_s().map(|change_s| worst_step_m(studio, command, change_s, dt_s)).fold(0.0, f32::max);
    let stands = match (command(0.0).0, command(WATCHED_S).0) {
        (Vec2::ZERO, _) => Stands::AtFirst,
        (_, Vec2::ZERO) => Stands::AtLast,
        _ => Stands::Never,
    };
    Step { dt_s, command: name, worst_cm: 100.0 * f64::from(worst_m), stands }
}

/// Furthest off after a step, from the moment on at which the command changes.
fn worst_step_m(studio: &SynthesisContext, command: Command, change_s: f32, dt_s: f32) -> f32 {
    // A step is commanded what is right in its middle.
    let at = |step: usize| command((step as f32 + 0.5) * dt_s - change_s);
    let plan = |time_s: f32, _: &Root| {
        let (velocity_mps, facing_rad) = at((time_s / dt_s).round() as usize);
        Plan { velocity_mps, facing_rad, time_to_collision_s: f32::INFINITY, ..Plan::default() }
    };
    let roots = roots(studio, change_s + WATCHED_S, dt_s, plan);
    let off_m = |(step, pair): (usize, &[Root])| {
        let moved_m = pair[1].position_m - pair[0].position_m;
        moved_m.distance(at(step).0 * dt_s)
    };
    roots.windows(2).enumerate().skip((change_s / dt_s).round() as usize).map(off_m).fold(0.0, f32::max)
}

/// Those that the database has.
fn ways(studio: &SynthesisContext) -> Vec<(&'static str, Vec3)> {
    let had = |way: Vec3| studio.domain.reachable(Parameters::from_vec3(way)).parameters.to_vec3().distance(way) < 1e-3;
    WAYS.into_iter().map(|(name, way)| (name, Vec3::from(way))).filter(|&(_, way)| had(way)).collect()
}

/// Each with each other.
fn pairs(ways: &[(&str, Vec3)]) -> Vec<(Vec3, Vec3)> {
    let pairs = ways.iter().flat_map(|&(_, from)| ways.iter().map(move |&(_, to)| (from, to)));
    pairs.filter(|(from, to)| from != to).collect()
}

fn change(studio: &SynthesisContext, from: Vec3, to: Vec3, dt_s: f32) -> Change {
    let behind_m = moments_s().map(|change_s| behind_m(studio, from, to, change_s, dt_s)).fold(0.0, f32::max);
    Change { dt_s, from: from.to_array(), to: to.to_array(), behind_cm: 100.0 * f64::from(behind_m) }
}

/// How far behind a cycle after the change.
fn behind_m(studio: &SynthesisContext, from: Vec3, to: Vec3, change_s: f32, dt_s: f32) -> f32 {
    let steady_s = (to - from).length() / ACCELERATION_MPS2;
    let asked = |time_s: f32| {
        let done = ((time_s - change_s) / steady_s).clamp(0.0, 1.0);
        Parameters::from_vec3(from.lerp(to, done))
    };
    let middle = |time_s: f32| asked(time_s + 0.5 * dt_s);
    let seconds = change_s + steady_s + cycle_s(studio, to);
    let roots = asked_roots(studio, seconds, dt_s, middle);
    let changed = (change_s / dt_s).round() as usize;
    let told = (changed..roots.len() - 1)
        .fold(roots[changed], |root, step| moved_root(&root, &middle(step as f32 * dt_s), dt_s));
    roots[roots.len() - 1].position_m.distance(told.position_m)
}

/// The cycle of a way to walk, s.
fn cycle_s(studio: &SynthesisContext, way: Vec3) -> f32 {
    let shares = studio.domain.locate(Parameters::from_vec3(way));
    let rates = shares.examples.iter().zip(shares.shares);
    1.0 / rates.map(|(&example, share)| share / studio.db.examples[example as usize].phase_map.period_s).sum::<f32>()
}

fn bars(steps: &[Step], changes: &[Change], dt_s: f32) -> Vec<Bar> {
    let bars =
        [(Stands::Never, "change"), (Stands::AtFirst, "start"), (Stands::AtLast, "stop")].map(|(stands, word)| {
            let steps = steps.iter().filter(|step| step.dt_s == dt_s && step.stands == stands);
            let changes = changes.iter().filter(|change| change.dt_s == dt_s && change.stands() == stands);
            [
                Bar::at_most(
                    format!("semi-procedural, worst step of {dt_s:.4} s off its command in a {word}, cm"),
                    STEP_MAX_CM,
                    steps.map(|step| step.worst_cm).reduce(f64::max),
                ),
                Bar::at_most(
                    format!("blending in steps of {dt_s:.4} s, behind one cycle after a {word}, cm"),
                    BEHIND_MAX_CM,
                    changes.map(|change| change.behind_cm).reduce(f64::max),
                ),
            ]
        });
    bars.into_iter().flatten().collect()
}

impl Change {
    fn stands(&self) -> Stands {
        match [self.from, self.to].map(|way| way == [0.0; 3]) {
            [true, _] => Stands::AtFirst,
            [_, true] => Stands::AtLast,
            _ => Stands::Never,
        }
    }
}

/// A line a command; then for each dt a row a way to come from, a column a way to change to.
fn text(details: &Details, ways: &[(&'static str, Vec3)]) -> String {
    let mut text = "semi-procedural, worst step off its command, cm, in steps of 1/120, 1/30 and 0.1 s\n".to_owned();
    for (name, _) in COMMANDS {
        let worst = details.steps.iter().filter(|step| step.command == name);
        let worst: String = worst.map(|step| format!("{:8.2}", step.worst_cm)).collect();
        text += &format!("{name:>24}{worst}\n");
    }
    for dt_s in DT_S {
        text += &format!("blending in steps of {dt_s:.4} s, behind after one cycle, cm: from row to column\n");
        text += &format!("{:12}{}\n", "", ways.iter().map(|(name, _)| format!("{name:>12}")).collect::<String>());
        for &(name, from) in ways {
            let cells = ways.iter().map(|&(_, to)| format!("{:>12}", details.cell(from, to, dt_s)));
            text += &format!("{name:>12}{}\n", cells.collect::<String>());
        }
    }
    text
}

impl Details {
    /// Empty on the diagonal.
    fn cell(&self, from: Vec3, to: Vec3, dt_s: f32) -> String {
        let is_it = |change: &&Change| change.dt_s == dt_s && (change.from, change.to) == (from.into(), to.into());
        self.changes.iter().find(is_it).map_or_else(String::new, |change| format!("{:.2}", change.behind_cm))
    }
}

//! `fbcrowd bench tracking`: how closely does a root follow its commands (`FbCrowd` §5)?
//!
//! Commands accelerate by no more than [`ACCELERATION_MPS2`]. Semi-procedural locomotion is given velocities in the
//! world, and judged by each step: how far the root is from where the command would have brought it from its last
//! place. Blending is given (v_f, ω_t, ω_s), a change from one steady way to walk to another, and judged by how far its
//! root has then fallen behind one that did exactly as told, a cycle after the command has become steady. A body that
//! is to stop finishes its step: how far that leads is told, not judged.

use std::f32::consts::FRAC_PI_2;
use std::path::PathBuf;

use fbcrowd_sim::hms::Body;
use fbcrowd_sim::hms::mode::Mode;
use fbcrowd_sim::hms::params::Modes;
use fbcrowd_sim::hms::studio::Studio;
use fbcrowd_sim::plan::Plan;
use glam::{Vec2, Vec3};
use motiondb::parameters::Parameters;
use motiondb::pose::Root;
use serde::Serialize;

use super::bar::{Bar, Found, conclude};
use super::bundled::database;
use super::walker::{DT_S, asked_roots, studio};
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
const WAYS: [[f32; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [0.8, 0.0, 0.0],
    [1.1, 0.0, 0.0],
    [1.4, 0.0, 0.0],
    [0.8, 0.5, 0.0],
    [0.8, -0.5, 0.0],
    [0.8, 0.0, 0.2],
];

/// A velocity in the world and a facing, by the time since the command changed, s; before, what it is at 0.
type Command = fn(f32) -> (Vec2, f32);
const COMMANDS: [(&str, Command); 7] = [
    ("start", |time_s| (Vec2::new(ramp(time_s, 0.0, 1.2), 0.0), 0.0)),
    ("speed up", |time_s| (Vec2::new(ramp(time_s, 0.8, 1.4), 0.0), 0.0)),
    ("slow down", |time_s| (Vec2::new(ramp(time_s, 1.4, 0.7), 0.0), 0.0)),
    ("dodge", |time_s| (Vec2::new(1.0, ramp(time_s, 0.0, 0.4)), 0.0)),
    ("step back", |time_s| (Vec2::new(ramp(time_s, 0.6, -0.5), 0.0), 0.0)),
    ("wide curve", |time_s| curve(time_s, 1.2, 0.8)),
    ("tight curve", |time_s| curve(time_s, 1.2, ACCELERATION_MPS2 / 1.2)),
];

/// Measure how closely roots follow their commands.
///
/// In JSON `steps[] {dt_s, command, worst_cm}` of semi-procedural locomotion and `changes[] {dt_s, from[3], to[3],
/// behind_cm}` of blending, (v_f, ω_t, ω_s) in m/s and rad/s.
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
    /// Null where the body never walked so.
    worst_cm: Option<f64>,
}

/// A change of what is asked of blending.
#[derive(Serialize)]
struct Change {
    dt_s: f32,
    from: [f32; 3],
    to: [f32; 3],
    behind_cm: f64,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = database(args.database.as_deref())?;
    let exact = studio(db.clone(), Modes::SemiProcedural);
    let blending = studio(db, Modes::Blending);
    let (mut steps, mut changes) = (Vec::new(), Vec::new());
    for dt_s in DT_S {
        steps.extend(COMMANDS.map(|(name, command)| step(&exact, name, command, dt_s)));
        changes.extend(ways(&blending).into_iter().map(|(from, to)| change(&blending, from, to, dt_s)));
    }
    let bars = DT_S.iter().flat_map(|&dt_s| bars(&steps, &changes, dt_s)).collect();
    let details = Details { steps, changes };
    let text = text(&details);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

/// From one value to another at the greatest acceleration.
fn ramp(time_s: f32, from: f32, to: f32) -> f32 {
    from + (to - from).signum() * (ACCELERATION_MPS2 * time_s.max(0.0)).min((to - from).abs())
}

/// A right angle to the left, the facing along the velocity.
fn curve(time_s: f32, speed_mps: f32, turn_rate_rad_s: f32) -> (Vec2, f32) {
    let angle_rad = (turn_rate_rad_s * time_s).clamp(0.0, FRAC_PI_2);
    (Vec2::from_angle(angle_rad) * speed_mps, angle_rad)
}

fn step(studio: &Studio, name: &'static str, command: Command, dt_s: f32) -> Step {
    // A step is commanded what is right in its middle.
    let at = |step: usize| command((step as f32 + 0.5) * dt_s - CHANGE_S);
    let plan = |time_s: f32, _: &Root| {
        let (velocity_mps, facing_rad) = at((time_s / dt_s).round() as usize);
        Plan { velocity_mps, facing_rad, time_to_collision_s: f32::INFINITY, ..Plan::default() }
    };
    let bodies = studio.walk(0.0, CHANGE_S + WATCHED_S, dt_s, plan, |body, _| *body);
    let changed = (CHANGE_S / dt_s).round() as usize;
    let off_m = |(step, pair): (usize, &[Body])| {
        let moved_m = pair[1].root.position_m - pair[0].root.position_m;
        moved_m.distance(at(step).0 * dt_s)
    };
    let steps = bodies.windows(2).enumerate().skip(changed).filter(|(_, pair)| pair[0].mode == Mode::SemiProcedural);
    Step { dt_s, command: name, worst_cm: steps.map(off_m).reduce(f32::max).map(|worst_m| 100.0 * f64::from(worst_m)) }
}

/// Pairs of the ways that the database has.
fn ways(studio: &Studio) -> Vec<(Vec3, Vec3)> {
    let had = |way: &Vec3| studio.space.nearest(Parameters::from_vec3(*way)).parameters.to_vec3().distance(*way) < 1e-3;
    let ways: Vec<Vec3> = WAYS.into_iter().map(Vec3::from).filter(had).collect();
    let pairs = ways.iter().flat_map(|&from| ways.iter().map(move |&to| (from, to)));
    pairs.filter(|(from, to)| from != to).collect()
}

fn change(studio: &Studio, from: Vec3, to: Vec3, dt_s: f32) -> Change {
    let steady_s = (to - from).length() / ACCELERATION_MPS2;
    let asked = |time_s: f32| {
        let done = ((time_s - CHANGE_S) / steady_s).clamp(0.0, 1.0);
        Parameters::from_vec3(from.lerp(to, done))
    };
    let middle = |time_s: f32| asked(time_s + 0.5 * dt_s);
    let seconds = CHANGE_S + steady_s + cycle_s(studio, to);
    let roots = asked_roots(studio, seconds, dt_s, middle);
    let changed = (CHANGE_S / dt_s).round() as usize;
    let told =
        (changed..roots.len() - 1).fold(roots[changed], |root, step| walked(&root, middle(step as f32 * dt_s), dt_s));
    let behind_m = roots[roots.len() - 1].position_m.distance(told.position_m);
    Change { dt_s, from: from.to_array(), to: to.to_array(), behind_cm: 100.0 * f64::from(behind_m) }
}

/// The cycle of a way to walk, s.
fn cycle_s(studio: &Studio, way: Vec3) -> f32 {
    let shares = studio.space.locate(Parameters::from_vec3(way));
    let rates = shares.examples.iter().zip(shares.shares);
    1.0 / rates.map(|(&example, share)| share / studio.db.examples[example as usize].phase_map.period_s).sum::<f32>()
}

/// A root that does as told.
fn walked(root: &Root, told: Parameters, dt_s: f32) -> Root {
    let middle_rad = root.facing_rad + 0.5 * dt_s * told.turn_rate_rad_s;
    let moved_m = Vec2::from_angle(middle_rad).rotate(Vec2::new(told.speed_mps, told.strafe_mps)) * dt_s;
    Root { position_m: root.position_m + moved_m, facing_rad: root.facing_rad + dt_s * told.turn_rate_rad_s }
}

fn bars(steps: &[Step], changes: &[Change], dt_s: f32) -> [Bar; 3] {
    let steps_cm = steps.iter().filter(|step| step.dt_s == dt_s).filter_map(|step| step.worst_cm);
    let behind_cm = |stands: bool| {
        let told = changes.iter().filter(|change| change.dt_s == dt_s && Vec3::from(change.to) != Vec3::ZERO);
        let told = told.filter(|change| (Vec3::from(change.from) == Vec3::ZERO) == stands);
        told.map(|change| change.behind_cm).reduce(f64::max)
    };
    [
        Bar::at_most(
            format!("semi-procedural, worst step of {dt_s:.4} s off its command, cm"),
            STEP_MAX_CM,
            steps_cm.reduce(f64::max),
        ),
        Bar::at_most(
            format!("blending in steps of {dt_s:.4} s, behind one cycle after a change, cm"),
            BEHIND_MAX_CM,
            behind_cm(false),
        ),
        Bar::at_most(
            format!("blending in steps of {dt_s:.4} s, behind one cycle after a start, cm"),
            BEHIND_MAX_CM,
            behind_cm(true),
        ),
    ]
}

fn text(details: &Details) -> String {
    let mut text = "semi-procedural, worst step off its command, cm, in steps of 1/120, 1/30 and 0.1 s\n".to_owned();
    for (name, _) in COMMANDS {
        let worst = details.steps.iter().filter(|step| step.command == name);
        let worst: String = worst
            .map(|step| step.worst_cm.map_or_else(|| "       –".to_owned(), |worst_cm| format!("{worst_cm:8.2}")))
            .collect();
        text += &format!("{name:>24}{worst}\n");
    }
    text += "blending, behind after one cycle, cm, likewise\n";
    let of_one = details.changes.len() / DT_S.len();
    for index in 0..of_one {
        let (from, to) = (details.changes[index].from, details.changes[index].to);
        let behind = details.changes.iter().skip(index).step_by(of_one);
        let behind: String = behind.map(|change| format!("{:8.2}", change.behind_cm)).collect();
        text += &format!("{:>24}{behind}\n", format!("{from:.1?} to {to:.1?}"));
    }
    text
}

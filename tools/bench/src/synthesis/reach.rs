//! `fbcrowd bench reach`: how far m_sp can be deformed (`FbCrowd` §5), and whether the synthesis keeps within that.
//!
//! A gait is reached where planted feet slide no more than m_sp's own (scaled by the cadence), ankles do not cross,
//! knees keep from their limits, and hips come down no further than in a crouch. Every border of the set that the
//! synthesis uses must be reached.

use fbcrowd_jobs::Observer;
use fbcrowd_sim::synthesis::semi_procedural::{BaseWalk, Deformation};
use glam::Vec2;
use motiondb::body::{Joint, Joints, Pose};
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::planted_feet::foot_slide;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::report::{BenchReport, Criterion};
use crate::synthesis::quality_figures::ankles_apart_m;

/// Directions of travel, counter-clockwise from ahead, degrees.
const DIRECTIONS_DEG: [f32; 12] = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0, 330.0];
/// Turn rates of each direction, up to the fastest of the synthesis, degrees per second.
const TURN_RATES_DEG_S: [f32; 7] = [0.0, 60.0, -60.0, 120.0, -120.0, 170.0, -170.0];
/// Steps between the speeds, m/s.
const STEP_MPS: f32 = 0.1;
/// Greatest speed, a sprint, m/s.
const SPEED_MAX_MPS: f32 = 5.0;
/// Slide beyond m_sp's own that the foot hold removes, cm/s.
const SLIDE_CM_S: f32 = 3.0;
/// Least flexion of a knee: straighter it snaps, degrees.
const KNEE_MIN_DEG: f32 = 3.0;
/// Least distance of the ankles to the side: nearer, the legs are crossed, m.
const ANKLES_MIN_M: f32 = 0.03;
/// Greatest distance of the hips below m_sp's lowest: lower, the body crouches, m.
const DROP_MAX_M: f32 = 0.1;

/// Measure how far the clip of semi-procedural locomotion can be deformed.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench reach\n  fbcrowd bench reach --db motion.fbdb --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Name of the example of semi-procedural locomotion.
    pub m_sp: String,
    /// Directions of travel at each turn rate.
    #[serde(rename = "ways")]
    pub directions: Vec<ReachedDirection>,
}

/// One direction of travel at one turn rate.
#[derive(JsonSchema, Serialize)]
pub struct ReachedDirection {
    /// Direction of travel, counter-clockwise from ahead, degrees.
    pub direction_deg: f32,
    /// Turn rate, degrees per second.
    pub turn_rate_deg_s: f32,
    /// Greatest speed that is reached, m/s; null where not even standing is.
    pub speed_mps: Option<f32>,
    /// What is wrong at the next speed; null where nothing is.
    pub ends_by: Option<GaitFault>,
    /// Greatest speed that the synthesis uses, m/s.
    pub used_mps: f32,
    /// What is wrong at that speed; null where nothing is.
    pub wrong_where_used: Option<GaitFault>,
}

impl ReachedDirection {
    /// Whether every speed that is used is reached. The last step of the search may pass the greatest one.
    fn is_reached(&self) -> bool {
        let within = self.speed_mps.is_some_and(|speed_mps| speed_mps + STEP_MPS >= self.used_mps);
        within && self.wrong_where_used.is_none()
    }
}

/// A fault of a deformed cycle.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GaitFault {
    /// Planted feet slide.
    Slide,
    /// The legs cross.
    CrossedLegs,
    /// A knee is straight.
    StretchedKnee,
    /// The hips are too low.
    Crouch,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or has no walk ahead.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = database(&args.database)?;
    let semi_procedural = semi_procedural(&db).ok_or(BenchError::NoWalk)?;
    let lowest_m = db.posed_rows(semi_procedural.example).iter().map(hips_m).fold(f32::INFINITY, f32::min);
    let fault = |parameters| fault(&db, &semi_procedural, lowest_m, parameters);
    let directions: Vec<ReachedDirection> = TURN_RATES_DEG_S
        .iter()
        .flat_map(|&turn| DIRECTIONS_DEG.map(|direction| reached_direction(&semi_procedural, &fault, direction, turn)))
        .collect();
    let reached = directions.iter().filter(|direction| direction.is_reached()).count();
    let share = reached as f64 / directions.len() as f64;
    let criteria = vec![Criterion::at_least("share of the directions that are used and reached", 1.0, share)];
    let details = Details { m_sp: db.examples[semi_procedural.example].name.clone(), directions };
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// The example of semi-procedural locomotion; none where the database has none.
fn semi_procedural(db: &MotionDb) -> Option<BaseWalk> {
    BaseWalk::new(db, db.correspondence.as_ref()?.semi_procedural as usize)
}

/// Increases the speed from 0 until something is wrong.
fn reached_direction(
    semi_procedural: &BaseWalk,
    fault: &impl Fn(Parameters) -> Option<GaitFault>,
    direction_deg: f32,
    turn_rate_deg_s: f32,
) -> ReachedDirection {
    let direction = Vec2::from_angle(direction_deg.to_radians());
    let at = |speed_mps: f32| Parameters {
        speed_mps: speed_mps * direction.x,
        turn_rate_rad_s: turn_rate_deg_s.to_radians(),
        strafe_mps: speed_mps * direction.y,
    };
    let used = semi_procedural.reachable(at(SPEED_MAX_MPS));
    let mut reached = ReachedDirection {
        direction_deg,
        turn_rate_deg_s,
        speed_mps: None,
        ends_by: None,
        used_mps: used.velocity_mps().length(),
        wrong_where_used: fault(used),
    };
    for step in 0..=(SPEED_MAX_MPS / STEP_MPS) as usize {
        let speed_mps = STEP_MPS * step as f32;
        reached.ends_by = fault(at(speed_mps));
        if reached.ends_by.is_some() {
            break;
        }
        reached.speed_mps = Some(speed_mps);
    }
    reached
}

/// The first fault of m_sp deformed to some parameters; none where there is none.
fn fault(db: &MotionDb, semi_procedural: &BaseWalk, lowest_m: f32, parameters: Parameters) -> Option<GaitFault> {
    let deformation = Deformation::new(semi_procedural, parameters);
    let cycle = deformation.cycle(db);
    let (joints, feet) = deformation.measurable(&db.skeleton, &cycle);
    let source_cm_s = db.examples[semi_procedural.example].planted_slide_cm_s;
    let limit_cm_s = semi_procedural.cadence(parameters) * source_cm_s + SLIDE_CM_S;
    let slide = foot_slide(&feet, parameters.to_vec3().as_dvec3());
    let wrong = [
        (GaitFault::Slide, slide.slide_cm_s > f64::from(limit_cm_s)),
        (GaitFault::CrossedLegs, joints.iter().any(|joints| ankles_apart_m(joints) < ANKLES_MIN_M)),
        (GaitFault::StretchedKnee, cycle.iter().any(|posture| least_flexion_deg(&posture.pose) < KNEE_MIN_DEG)),
        (GaitFault::Crouch, joints.iter().any(|joints| hips_m(joints) < lowest_m - DROP_MAX_M)),
    ];
    wrong.into_iter().find_map(|(fault, is_so)| is_so.then_some(fault))
}

fn hips_m(joints: &Joints) -> f32 {
    joints.positions_m[Joint::Pelvis.index()].z
}

fn least_flexion_deg(pose: &Pose) -> f32 {
    pose.knee_flexion_rad(0).min(pose.knee_flexion_rad(1)).to_degrees()
}

/// A line for each direction, a column for each turn rate: the speed that is reached, the speed that the synthesis
/// uses, and what ends it. A speed that is used and not reached is marked.
fn text(details: &Details) -> String {
    let mut text = format!("m_sp {}: speed reached (used; not reached!), m/s\ndirection", details.m_sp);
    for turn in TURN_RATES_DEG_S {
        text += &format!("{:>25}", format!("{turn} °/s"));
    }
    for (row, direction) in DIRECTIONS_DEG.iter().enumerate() {
        text += &format!("\n{direction:>7} °");
        for reached in details.directions.iter().skip(row).step_by(DIRECTIONS_DEG.len()) {
            let speed = reached.speed_mps.map_or_else(|| "–".to_owned(), |speed_mps| format!("{speed_mps:.1}"));
            let ends_by = reached.ends_by.map_or("", GaitFault::word);
            let mark = if reached.is_reached() { "" } else { "!" };
            text += &format!("{:>25}", format!("{speed} ({:.2}{mark}) {ends_by}", reached.used_mps));
        }
    }
    text + "\n"
}

impl GaitFault {
    fn word(self) -> &'static str {
        match self {
            Self::Slide => "slide",
            Self::CrossedLegs => "crossed legs",
            Self::StretchedKnee => "straight knee",
            Self::Crouch => "crouch",
        }
    }
}

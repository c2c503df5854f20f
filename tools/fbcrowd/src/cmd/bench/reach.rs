//! `fbcrowd bench reach`: how far can m_sp be deformed (`FbCrowd` §5), and does the synthesis stay within?
//!
//! A way to walk is reached where its planted feet slide no more than m_sp's own (scaled by the cadence), ankles do not
//! cross, knees keep from their ends, and hips come down no further than a crouch. Every border of the set that the
//! synthesis uses must be reached.

use std::path::PathBuf;

use fbcrowd_sim::synthesis::semi_procedural::{BaseWalk, Deformation};
use glam::Vec2;
use motiondb::body::{Joint, Joints, Pose};
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::planted_feet::foot_slide;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::quality_measures::ankles_apart_m;
use crate::failure::{Answer, Failure};

/// Directions of travel, from ahead on round by the left, degrees.
const DIRECTIONS_DEG: [f32; 12] = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0, 330.0];
/// Turn rates at which each direction is tried, up to the fastest that the synthesis turns, degrees a second.
const TURN_RATES_DEG_S: [f32; 7] = [0.0, 60.0, -60.0, 120.0, -120.0, 170.0, -170.0];
/// Speeds are tried in such steps, m/s, up to a sprint.
const STEP_MPS: f32 = 0.1;
const SPEED_MAX_MPS: f32 = 5.0;
/// Slide beyond m_sp's own that the foot hold takes out, cm/s.
const SLIDE_CM_S: f32 = 3.0;
/// A knee nearer to its end than this would snap, degrees.
const KNEE_MIN_DEG: f32 = 3.0;
/// Ankles nearer than this, side by side, belong to crossed legs, m.
const ANKLES_MIN_M: f32 = 0.03;
/// Hips this much lower than m_sp's lowest belong to a crouch, m.
const DROP_MAX_M: f32 = 0.1;

/// Measure how far the clip of semi-procedural locomotion can be deformed.
///
/// In JSON `m_sp`, `ways[] {direction_deg, turn_rate_deg_s, speed_mps, ends_by, used_mps, wrong_where_used}`: the
/// greatest speed reached in each direction at each turn rate and what ends it; the greatest that the synthesis asks
/// for, and what is wrong there, if anything.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench reach\n  fbcrowd bench reach --db motion.fbdb --json")]
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
    m_sp: String,
    ways: Vec<Way>,
}

/// One direction at one turn rate.
#[derive(Serialize)]
struct Way {
    direction_deg: f32,
    turn_rate_deg_s: f32,
    /// Null where not even standing is reached.
    speed_mps: Option<f32>,
    /// Null where nothing ends it.
    ends_by: Option<Fault>,
    used_mps: f32,
    /// Null where nothing is.
    wrong_where_used: Option<Fault>,
}

impl Way {
    /// Whether the border of what is used is reached, and everything within: the last step outward may pass it.
    fn is_reached(&self) -> bool {
        let within = self.speed_mps.is_some_and(|speed_mps| speed_mps + STEP_MPS >= self.used_mps);
        within && self.wrong_where_used.is_none()
    }
}

/// What is wrong with a deformed cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Fault {
    Slide,
    CrossedLegs,
    StretchedKnee,
    Crouch,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = database(args.database.as_deref())?;
    let Some(semi_procedural) = semi_procedural(&db) else {
        return Err(Failure::bad("the database has no walk ahead that could be deformed; add one"));
    };
    let lowest_m = db.posed_rows(semi_procedural.example).iter().map(hips_m).fold(f32::INFINITY, f32::min);
    let fault = |parameters| fault(&db, &semi_procedural, lowest_m, parameters);
    let ways: Vec<Way> = TURN_RATES_DEG_S
        .iter()
        .flat_map(|&turn| DIRECTIONS_DEG.map(|direction| way(&semi_procedural, &fault, direction, turn)))
        .collect();
    let share = ways.iter().filter(|way| way.is_reached()).count() as f64 / ways.len() as f64;
    let bars = vec![Bar::at_least("share of the ways that are used and reached", 1.0, share)];
    let details = Details { m_sp: db.examples[semi_procedural.example].name.clone(), ways };
    let text = text(&details);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

fn semi_procedural(db: &MotionDb) -> Option<BaseWalk> {
    BaseWalk::new(db, db.correspondence.as_ref()?.semi_procedural as usize)
}

/// From standing on outward, until something is wrong.
fn way(
    semi_procedural: &BaseWalk,
    fault: &impl Fn(Parameters) -> Option<Fault>,
    direction_deg: f32,
    turn_rate_deg_s: f32,
) -> Way {
    let direction = Vec2::from_angle(direction_deg.to_radians());
    let at = |speed_mps: f32| Parameters {
        speed_mps: speed_mps * direction.x,
        turn_rate_rad_s: turn_rate_deg_s.to_radians(),
        strafe_mps: speed_mps * direction.y,
    };
    let used = semi_procedural.reachable(at(SPEED_MAX_MPS));
    let mut way = Way {
        direction_deg,
        turn_rate_deg_s,
        speed_mps: None,
        ends_by: None,
        used_mps: Vec2::new(used.speed_mps, used.strafe_mps).length(),
        wrong_where_used: fault(used),
    };
    for step in 0..=(SPEED_MAX_MPS / STEP_MPS) as usize {
        let speed_mps = STEP_MPS * step as f32;
        way.ends_by = fault(at(speed_mps));
        if way.ends_by.is_some() {
            break;
        }
        way.speed_mps = Some(speed_mps);
    }
    way
}

/// What is wrong first with m_sp deformed to some parameters.
fn fault(db: &MotionDb, semi_procedural: &BaseWalk, lowest_m: f32, parameters: Parameters) -> Option<Fault> {
    let deformation = Deformation::new(semi_procedural, parameters);
    let cycle = deformation.cycle(db);
    let (joints, feet) = deformation.measurable(&db.skeleton, &cycle);
    let source_cm_s = db.examples[semi_procedural.example].planted_slide_cm_s;
    let bar_cm_s = semi_procedural.cadence(parameters) * source_cm_s + SLIDE_CM_S;
    let slide = foot_slide(&feet, parameters.to_vec3().as_dvec3());
    let wrong = [
        (Fault::Slide, slide.slide_cm_s > f64::from(bar_cm_s)),
        (Fault::CrossedLegs, joints.iter().any(|joints| ankles_apart_m(joints) < ANKLES_MIN_M)),
        (Fault::StretchedKnee, cycle.iter().any(|posture| least_flexion_deg(&posture.pose) < KNEE_MIN_DEG)),
        (Fault::Crouch, joints.iter().any(|joints| hips_m(joints) < lowest_m - DROP_MAX_M)),
    ];
    wrong.into_iter().find_map(|(fault, is_so)| is_so.then_some(fault))
}

fn hips_m(joints: &Joints) -> f32 {
    joints.positions_m[Joint::Pelvis.index()].z
}

fn least_flexion_deg(pose: &Pose) -> f32 {
    pose.knee_flexion_rad(0).min(pose.knee_flexion_rad(1)).to_degrees()
}

/// A line a direction, a column a turn rate: the speed reached, what the synthesis uses of it, what ends it. What is
/// used and not reached is marked.
fn text(details: &Details) -> String {
    let mut text = format!("m_sp {}: speed reached (used; not reached!), m/s\ndirection", details.m_sp);
    for turn in TURN_RATES_DEG_S {
        text += &format!("{:>25}", format!("{turn} °/s"));
    }
    for (row, direction) in DIRECTIONS_DEG.iter().enumerate() {
        text += &format!("\n{direction:>7} °");
        for way in details.ways.iter().skip(row).step_by(DIRECTIONS_DEG.len()) {
            let reached = way.speed_mps.map_or_else(|| "–".to_owned(), |speed_mps| format!("{speed_mps:.1}"));
            let ends_by = way.ends_by.map_or("", Fault::word);
            let mark = if way.is_reached() { "" } else { "!" };
            text += &format!("{:>25}", format!("{reached} ({:.2}{mark}) {ends_by}", way.used_mps));
        }
    }
    text + "\n"
}

impl Fault {
    fn word(self) -> &'static str {
        match self {
            Self::Slide => "slide",
            Self::CrossedLegs => "crossed legs",
            Self::StretchedKnee => "straight knee",
            Self::Crouch => "crouch",
        }
    }
}

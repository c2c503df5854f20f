//! Quality of the motion of each action: measures, and findings for those beyond a threshold.
//!
//! Enters: a valid database; poses in the root frame, roots in the first root frame. The measures and thresholds are
//! those of examples ([`crate::quality::example_quality`]) as far as they apply to a motion that is no cycle.

use glam::Vec3;
use serde::Serialize;

use crate::body::pose::{Joints, Pose};
use crate::motion::action::{ACTION_RATE_HZ, Action, ActionFrame};
use crate::motion::motion_db::MotionDb;
use crate::quality::body_figures::BodyFigures;
use crate::quality::example_quality::suspect_slide_cm_s;
use crate::quality::finding::{FigureLimit, Finding, up_to};
use crate::quality::planted_feet::{PLANTED_CONTACT, TRIMMED_SHARE, lowest_points};

/// Measures of one action.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActionQuality {
    /// Name of the action.
    pub action: String,
    /// Mean speed of planted feet, cm/s; 0 where no foot is planted.
    pub planted_slide_cm_s: f32,
    /// Greatest depth of a sole below the ground, mm.
    pub penetration_mm: f32,
    /// Least flexion of a knee, degrees; negative if hyperextended.
    pub knee_flexion_min_deg: f32,
    /// Greatest distance from hip to ankle, divided by thigh plus shank.
    pub leg_extension_max: f32,
    /// Greatest turn of a joint beyond the published human range, degrees; 0 within.
    pub range_excess_deg: f32,
    /// Name of the joint of `range_excess_deg`.
    pub range_excess_joint: &'static str,
}

/// Measures of an action of a database. The database must be valid.
pub fn quality(db: &MotionDb, action: &Action) -> ActionQuality {
    let (joints, body) = measured(db, action);
    ActionQuality {
        action: action.name.clone(),
        planted_slide_cm_s: planted_slide_cm_s(db, action, &joints),
        penetration_mm: body.penetration_mm,
        knee_flexion_min_deg: body.knee_flexion_min_deg,
        leg_extension_max: body.leg_extension_max,
        range_excess_deg: body.range_excess_deg,
        range_excess_joint: body.range_excess_joint,
    }
}

/// Findings about an action for all measures beyond their thresholds. The database must be valid.
pub fn findings(db: &MotionDb, action: &Action) -> Vec<Finding> {
    let (joints, body) = measured(db, action);
    let slide = slide_limit(planted_slide_cm_s(db, action, &joints), mean_speed_mps(action));
    [slide].into_iter().chain(body.limits()).filter_map(|limit| limit.finding(&action.name)).collect()
}

/// Findings about all actions, in order. Mirrored actions repeat their originals and are left out. The database must be
/// valid.
pub fn lint(db: &MotionDb) -> Vec<Finding> {
    db.actions.iter().filter(|action| !action.mirrored).flat_map(|action| findings(db, action)).collect()
}

fn measured(db: &MotionDb, action: &Action) -> (Vec<Joints>, BodyFigures) {
    let poses: Vec<Pose> = action.frames.iter().map(|frame| frame.pose).collect();
    let joints: Vec<Joints> = poses.iter().map(|pose| pose.forward_kinematics(&db.skeleton)).collect();
    let body = BodyFigures::of(&poses, &joints, &db.skeleton);
    (joints, body)
}

fn slide_limit(slide_cm_s: f32, speed_mps: f32) -> FigureLimit {
    let most_cm_s = suspect_slide_cm_s(speed_mps);
    let sentence = format!("planted feet slide by {slide_cm_s:.0} cm/s; usual at this speed is {most_cm_s:.0} at most");
    let measure = "planted_slide_cm_s";
    FigureLimit { measure, unit: "cm/s", value: slide_cm_s, range: up_to(most_cm_s), sentence }
}

/// Mean speed of the root along its path, m/s.
fn mean_speed_mps(action: &Action) -> f32 {
    let steps = action.frames.windows(2).map(|pair| pair[1].root.position_m.distance(pair[0].root.position_m));
    steps.sum::<f32>() / action.duration_s()
}

/// Mean speed of the contact points of planted feet over the middle part of each contact, cm/s.
fn planted_slide_cm_s(db: &MotionDb, action: &Action, joints: &[Joints]) -> f32 {
    let speeds_mps: Vec<f32> =
        [0, 1].into_iter().flat_map(|side| planted_speeds_mps(db, action, joints, side)).collect();
    100.0 * speeds_mps.iter().sum::<f32>() / speeds_mps.len().max(1) as f32
}

/// Horizontal speeds of a foot's contact point in the middle of each contact, m/s, by central differences.
fn planted_speeds_mps(db: &MotionDb, action: &Action, joints: &[Joints], side: usize) -> Vec<f32> {
    let in_world = |(joints, frame): (&Joints, &ActionFrame)| {
        joints.measured_points_m(&db.skeleton, side).map(|point_m| frame.root.to_world(point_m))
    };
    let points_m: Vec<[Vec3; 3]> = joints.iter().zip(&action.frames).map(in_world).collect();
    let lowest = lowest_points(&points_m.iter().map(|foot| foot.map(|point_m| point_m.as_dvec3())).collect::<Vec<_>>());
    let last = points_m.len() - 1;
    let speed_mps = |frame: usize| {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(last));
        let point = lowest[frame];
        let moved_m = points_m[after][point].truncate().distance(points_m[before][point].truncate());
        moved_m * ACTION_RATE_HZ / (after - before) as f32
    };
    contacts(action, side).into_iter().flat_map(|[first, end]| (first..end).map(speed_mps)).collect()
}

/// The middle part of each contact of a foot: its first frame and the one after its last.
fn contacts(action: &Action, side: usize) -> Vec<[usize; 2]> {
    let is_planted = |frame: usize| f64::from(action.frames[frame].contacts[side]) >= PLANTED_CONTACT;
    let count = action.frames.len();
    let starts = (0..count).filter(|&frame| is_planted(frame) && (frame == 0 || !is_planted(frame - 1)));
    let middle = |start: usize| {
        let length = (start..count).take_while(|&frame| is_planted(frame)).count();
        let trim = (TRIMMED_SHARE * length as f64 + 0.5) as usize;
        [start + trim, start + length - trim]
    };
    starts.map(middle).collect()
}

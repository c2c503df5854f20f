//! Quality of the motion of each example: measures, and findings for those beyond a threshold.
//!
//! Enters: a valid database; poses in the root frame. Leaves: measures whose names end in their units. Thresholds lie
//! just beyond the values of good captures, so most clips pass. A finding does not make a database invalid
//! ([`crate::validate`] decides that): the motion is played as it is.

use glam::{Quat, Vec3};
use serde::Serialize;

use crate::body::pose::Pose;
use crate::body::skeleton::JOINT_COUNT;
use crate::motion::motion_db::{MotionDb, MotionExample, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::quality::body_figures::BodyFigures;
use crate::quality::coverage::RUN_MPS;
use crate::quality::finding::{FigureLimit, Finding, up_to};
use crate::statistics::median;

/// Greatest usual slide of planted feet at rest, cm/s: clean walks slide by 2–8 (`docs/tuning.md`).
const SUSPECT_SLIDE_CM_S: f32 = 10.0;
/// Increase of the usual slide with the body's speed, cm/s per m/s: from clean runs (`docs/tuning.md`).
const SUSPECT_SLIDE_CM_S_PER_MPS: f32 = 6.0;
/// Usual planted share of a walk: clean captures have 0.45–0.65 (`docs/tuning.md`).
const WALKING_SHARE: [f32; 2] = [0.35, 0.8];
/// Usual planted share of a run: clean captures have 0.28–0.45, sprints 0.22.
const RUNNING_SHARE: [f32; 2] = [0.22, 0.5];
/// Usual planted share of a standing body: no foot is off the ground for long.
const STANDING_SHARE: [f32; 2] = [0.9, 1.0];
/// Greatest turn at the seam, divided by the median turn of the cycle: 1.5 is not visible, 3 is (measured).
const SEAM_ANGLE_MAX: f32 = 2.0;
/// Greatest change of angular velocity at the seam, divided by the cycle's median: 2.8 is not visible, 9 is (measured).
const SEAM_VELOCITY_MAX: f32 = 4.0;
/// Least median of both ratios, rad per joint and row: 0.05°, since smaller steps are not visible.
const SEAM_STEP_MIN_RAD: f32 = 0.05 * std::f32::consts::PI / 180.0;
/// Measures of one example.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExampleQuality {
    /// Name of the example.
    pub example: String,
    /// Mean speed of planted feet, cm/s.
    pub planted_slide_cm_s: f32,
    /// Share of the cycle in which a foot is planted, mean of both feet.
    pub planted_share: f32,
    /// Turn of the joints from the last row to the first (root mean square), divided by the median turn between rows.
    pub seam_angle_ratio: f32,
    /// Greatest change of angular velocity at the seam (root mean square over joints), divided by the median change.
    pub seam_velocity_ratio: f32,
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

/// The gait of a body that steps at a speed over the ground, and the usual planted share in it, from and to.
pub fn usual_planted_share(speed_mps: f32) -> (&'static str, [f32; 2]) {
    if speed_mps < RUN_MPS { ("walking", WALKING_SHARE) } else { ("running", RUNNING_SHARE) }
}

/// Least suspect slide of planted feet, cm/s, at a body's speed over the ground.
pub fn suspect_slide_cm_s(speed_mps: f32) -> f32 {
    SUSPECT_SLIDE_CM_S + SUSPECT_SLIDE_CM_S_PER_MPS * speed_mps
}

/// Measures of every example, in order. The database must be valid.
pub fn quality(db: &MotionDb) -> Vec<ExampleQuality> {
    (0..db.examples.len()).map(|example| example_quality(db, example)).collect()
}

/// Findings for all measures beyond their thresholds, in order of examples. Mirrored examples repeat their originals
/// and are left out. The database must be valid.
pub fn lint(db: &MotionDb) -> Vec<Finding> {
    let recorded = quality(db).into_iter().enumerate().filter(|(index, _)| !db.examples[*index].mirrored);
    recorded.flat_map(|(index, found)| findings(db, index, &found)).collect()
}

fn example_quality(db: &MotionDb, index: usize) -> ExampleQuality {
    let example = &db.examples[index];
    let [seam_angle_ratio, seam_velocity_ratio] = seam_ratios(&turns(db, index));
    let body = body_figures(db, index);
    ExampleQuality {
        example: example.name.clone(),
        planted_slide_cm_s: example.planted_slide_cm_s,
        planted_share: example.planted_share,
        seam_angle_ratio,
        seam_velocity_ratio,
        penetration_mm: body.penetration_mm,
        knee_flexion_min_deg: body.knee_flexion_min_deg,
        leg_extension_max: body.leg_extension_max,
        range_excess_deg: body.range_excess_deg,
        range_excess_joint: body.range_excess_joint,
    }
}

fn body_figures(db: &MotionDb, example: usize) -> BodyFigures {
    let poses: Vec<Pose> = (0..PHASE_COUNT).map(|row| db.rows.pose(example, row)).collect();
    BodyFigures::of(&poses, &db.posed_rows(example), &db.skeleton)
}

/// Turn of each joint from each row to the next (from the last to the first), as a rotation vector in the joint's
/// frame.
fn turns(db: &MotionDb, example: usize) -> Vec<[Vec3; JOINT_COUNT]> {
    let turn = |from: Quat, to: Quat| {
        let turn = from.inverse() * to;
        (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis()
    };
    let of_row = |row: usize| {
        let (from, to) = (db.rows.rotations(example, row), db.rows.rotations(example, (row + 1) % PHASE_COUNT));
        std::array::from_fn(|joint| turn(from[joint], to[joint]))
    };
    (0..PHASE_COUNT).map(of_row).collect()
}

/// Ratios of the seam: turn divided by the median turn, and change of angular velocity divided by the median change.
fn seam_ratios(turns: &[[Vec3; JOINT_COUNT]]) -> [f32; 2] {
    let before = |row: usize| &turns[(row + PHASE_COUNT - 1) % PHASE_COUNT];
    let angles: Vec<f32> = turns.iter().map(|turn| rms(turn.iter().copied())).collect();
    let changes: Vec<f32> = (0..PHASE_COUNT)
        .map(|row| rms(turns[row].iter().zip(before(row)).map(|(after, before)| after - before)))
        .collect();
    let last = PHASE_COUNT - 1;
    [angles[last] / median_step_rad(&angles), changes[last].max(changes[0]) / median_step_rad(&changes)]
}

/// Root mean square over the joints.
fn rms(vectors: impl Iterator<Item = Vec3>) -> f32 {
    libm::sqrtf(vectors.map(Vec3::length_squared).sum::<f32>() / JOINT_COUNT as f32)
}

fn median_step_rad(steps_rad: &[f32]) -> f32 {
    let median_rad = median(steps_rad.iter().copied().map(f64::from)).unwrap_or_default() as f32;
    median_rad.max(SEAM_STEP_MIN_RAD)
}

fn findings(db: &MotionDb, index: usize, found: &ExampleQuality) -> Vec<Finding> {
    let of_contacts = contact_limits(found, &db.examples[index]);
    let limits = of_contacts.into_iter().chain(seam_limits(found)).chain(body_figures(db, index).limits());
    limits.filter_map(|limit| limit.finding(&found.example)).collect()
}

fn contact_limits(found: &ExampleQuality, example: &MotionExample) -> [FigureLimit; 2] {
    let Parameters { speed_mps, strafe_mps, .. } = example.parameters;
    let body_mps = libm::hypotf(speed_mps, strafe_mps);
    let (gait, [least, most]) = match example.key_times_s {
        None => ("standing", STANDING_SHARE),
        Some(_) => usual_planted_share(body_mps),
    };
    let slide_max_cm_s = suspect_slide_cm_s(body_mps);
    let (slide_cm_s, share) = (found.planted_slide_cm_s, found.planted_share);
    let slide =
        format!("planted feet slide by {slide_cm_s:.0} cm/s; usual at this speed is {slide_max_cm_s:.0} at most");
    let [has, from, to] = [share, least, most].map(|share| 100.0 * share);
    let planted = format!("a foot is planted for {has:.0} % of the cycle; usual in {gait} is {from:.0} to {to:.0} %");
    let limit = |measure, unit, value, range, sentence| FigureLimit { measure, unit, value, range, sentence };
    [
        limit("planted_slide_cm_s", "cm/s", slide_cm_s, up_to(slide_max_cm_s), slide),
        limit("planted_share", "", share, [least, most], planted),
    ]
}

fn seam_limits(found: &ExampleQuality) -> [FigureLimit; 2] {
    let [angle, velocity] = [found.seam_angle_ratio, found.seam_velocity_ratio];
    let limit =
        |measure, value, greatest, sentence| FigureLimit { measure, unit: "", value, range: up_to(greatest), sentence };
    let jumps = format!("the pose jumps where the cycle closes, by {angle:.1} times a usual step");
    let jerks = format!("the motion jerks where the cycle closes, {velocity:.1} times as much as elsewhere");
    [
        limit("seam_angle_ratio", angle, SEAM_ANGLE_MAX, jumps),
        limit("seam_velocity_ratio", velocity, SEAM_VELOCITY_MAX, jerks),
    ]
}

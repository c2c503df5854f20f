//! Quality of the motion of each example: measures, and findings for those beyond a threshold.
//!
//! Enters: a valid database; poses in the root frame. Leaves: measures whose names end in their units. Thresholds lie
//! just beyond the values of good captures, so most clips pass. A finding does not make a database invalid
//! ([`crate::validate`] decides that): the motion is played as it is.

use glam::{Quat, Vec3};
use serde::Serialize;

use crate::body::joint_ranges::JOINT_RANGES_DEG;
use crate::body::pose::Joints;
use crate::body::skeleton::{JOINT_COUNT, Joint, Skeleton};
use crate::motion::motion_db::{MotionDb, MotionExample, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::quality::coverage::RUN_MPS;
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
/// Greatest depth of a sole below the ground, mm. The compiler permits 10, the give of pads and shoes; 20 is visible.
const PENETRATION_MAX_MM: f32 = 20.0;
/// Least flexion of a knee, degrees. People land on knees flexed by 3–5°; a straighter knee snaps.
const KNEE_FLEXION_MIN_DEG: f32 = 1.0;
/// Greatest distance of hip and ankle, divided by thigh plus shank. The compiler's leg inverse kinematics ends at
/// 0.9995 (a knee flexed by 3.6°), so a longer leg is the clip's own.
const LEG_EXTENSION_MAX: f32 = 0.9997;
/// Greatest turn of a joint beyond the published range, degrees: good clips exceed it by up to 42° (`docs/tuning.md`).
const RANGE_EXCESS_MAX_DEG: f32 = 45.0;

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

/// A measure beyond its threshold.
///
/// ```no_run
/// use motiondb::MotionDb;
/// use motiondb::quality::example_quality::lint;
///
/// fn print_findings(db: &MotionDb) {
///     for finding in lint(db) {
///         println!("{}: {}", finding.example, finding.sentence);
///     }
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the example.
    pub example: String,
    /// Name of the measure: its field in [`ExampleQuality`].
    pub measure: &'static str,
    /// Value of the measure.
    pub value: f32,
    /// Threshold of the measure.
    pub threshold: f32,
    /// Unit of value and threshold; empty for ratios and shares.
    pub unit: &'static str,
    /// The finding as a text for people, without the example's name.
    pub sentence: String,
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
    let recorded = quality(db).into_iter().zip(&db.examples).filter(|(_, example)| !example.mirrored);
    recorded.flat_map(|(found, example)| findings(&found, example)).collect()
}

fn example_quality(db: &MotionDb, index: usize) -> ExampleQuality {
    let (example, joints) = (&db.examples[index], db.posed_rows(index));
    let [seam_angle_ratio, seam_velocity_ratio] = seam_ratios(&turns(db, index));
    let (range_excess_deg, joint) = range_excess_deg(db, index);
    ExampleQuality {
        example: example.name.clone(),
        planted_slide_cm_s: example.planted_slide_cm_s,
        planted_share: example.planted_share,
        seam_angle_ratio,
        seam_velocity_ratio,
        penetration_mm: penetration_mm(&joints, &db.skeleton),
        knee_flexion_min_deg: knee_flexion_min_deg(db, index),
        leg_extension_max: leg_extension_max(&joints, &db.skeleton),
        range_excess_deg,
        range_excess_joint: joint.name(),
    }
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

fn penetration_mm(rows: &[Joints], skeleton: &Skeleton) -> f32 {
    let soles = rows.iter().flat_map(|joints| [0, 1].map(|side| joints.sole_points_m(skeleton, side)));
    1000.0 * soles.flatten().map(|point| -point.z).fold(0.0, f32::max)
}

fn knee_flexion_min_deg(db: &MotionDb, example: usize) -> f32 {
    let poses = (0..PHASE_COUNT).map(|row| db.rows.pose(example, row));
    let flexions_rad = poses.flat_map(|pose| [0, 1].map(|side| pose.knee_flexion_rad(side)));
    flexions_rad.fold(f32::INFINITY, f32::min).to_degrees()
}

fn leg_extension_max(rows: &[Joints], skeleton: &Skeleton) -> f32 {
    let extension = |joints: &Joints, side: usize| {
        let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(Joint::index);
        let leg_m = skeleton.offsets_m[shank].length() + skeleton.offsets_m[foot].length();
        joints.positions_m[thigh].distance(joints.positions_m[foot]) / leg_m
    };
    rows.iter().flat_map(|joints| [0, 1].map(|side| extension(joints, side))).fold(0.0, f32::max)
}

/// Greatest turn of a joint beyond its published range, degrees, and the joint.
fn range_excess_deg(db: &MotionDb, example: usize) -> (f32, Joint) {
    let mut worst = (0.0, Joint::Pelvis);
    for row in 0..PHASE_COUNT {
        for (joint, &rotation) in Joint::ALL.into_iter().zip(db.rows.rotations(example, row)) {
            let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
            let turned_deg = rotation.to_scaled_axis().map(f32::to_degrees);
            let [least, greatest] = JOINT_RANGES_DEG[joint.index()].map(Vec3::from_array);
            let excess_deg = (least - turned_deg).max(turned_deg - greatest).max_element();
            if excess_deg > worst.0 {
                worst = (excess_deg, joint);
            }
        }
    }
    worst
}

fn findings(found: &ExampleQuality, example: &MotionExample) -> Vec<Finding> {
    let limits = contact_limits(found, example).into_iter().chain(seam_limits(found)).chain(body_limits(found));
    limits.filter_map(|limit| limit.finding(&found.example)).collect()
}

/// A measure, its usual range, and the sentence of the finding beyond that range.
struct FigureLimit {
    measure: &'static str,
    unit: &'static str,
    value: f32,
    range: [f32; 2],
    sentence: String,
}

impl FigureLimit {
    fn finding(self, example: &str) -> Option<Finding> {
        let Self { measure, unit, value, range: [least, greatest], sentence } = self;
        let threshold = if value < least { least } else { greatest };
        let is_beyond = value < least || value > greatest;
        is_beyond.then(|| Finding { example: example.to_owned(), measure, value, threshold, unit, sentence })
    }
}

fn up_to(greatest: f32) -> [f32; 2] {
    [f32::NEG_INFINITY, greatest]
}

fn contact_limits(found: &ExampleQuality, example: &MotionExample) -> [FigureLimit; 2] {
    let Parameters { speed_mps, strafe_mps, .. } = example.parameters;
    let body_mps = libm::hypotf(speed_mps, strafe_mps);
    let (gait, [least, most]) = match example.key_times_s {
        None => ("standing", STANDING_SHARE),
        Some(_) if body_mps < RUN_MPS => ("walking", WALKING_SHARE),
        Some(_) => ("running", RUNNING_SHARE),
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

fn body_limits(found: &ExampleQuality) -> [FigureLimit; 4] {
    let (sunk_mm, flexed_deg) = (found.penetration_mm, found.knee_flexion_min_deg);
    let (joint, excess_deg) = (found.range_excess_joint, found.range_excess_deg);
    let limit = |measure, unit, value, range, sentence| FigureLimit { measure, unit, value, range, sentence };
    let sinks = format!("a sole sinks {sunk_mm:.0} mm into the ground");
    let straightens = format!("a knee straightens to {flexed_deg:.1}° of flexion: it snaps or bends backward");
    let stretched = "a leg is stretched to its full length; it may be too short for the clip's steps".to_owned();
    let turns = format!("{joint} turns {excess_deg:.0}° beyond the human range");
    [
        limit("penetration_mm", "mm", sunk_mm, up_to(PENETRATION_MAX_MM), sinks),
        limit("knee_flexion_min_deg", "deg", flexed_deg, [KNEE_FLEXION_MIN_DEG, f32::INFINITY], straightens),
        limit("leg_extension_max", "", found.leg_extension_max, up_to(LEG_EXTENSION_MAX), stretched),
        limit("range_excess_deg", "deg", excess_deg, up_to(RANGE_EXCESS_MAX_DEG), turns),
    ]
}

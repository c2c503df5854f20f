//! How good the motion of each example is: plain figures, and those that a person should look at.
//!
//! No figure here makes a database unsound ([`crate::validate`] does that): a sliding foot is played as it is. The
//! thresholds lie just beyond what good captures show, so that most clips pass in silence; each names its source.
//! Poses in the root frame; figures carry their units.

use glam::{Quat, Vec3};
use serde::Serialize;

use crate::body::joint_ranges::JOINT_RANGES_DEG;
use crate::body::pose::Joints;
use crate::body::skeleton::{JOINT_COUNT, Joint, Skeleton};
use crate::motion::motion_db::{MotionDb, MotionExample, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::quality::coverage::RUN_MPS;
use crate::statistics::median;

/// Planted feet of clean walks slide by 2–8 cm/s, of runs by 6 cm/s more for each m/s (`SmartBody`, Bandai Namco): 12.4
/// of fast side-steps, 22 and 28 of runs at 3 and 3.9 m/s. Of 84 examples of 65 clips three slide more, two of them
/// drawn.
const SUSPECT_SLIDE_CM_S: f32 = 10.0;
const SUSPECT_SLIDE_CM_S_PER_MPS: f32 = 6.0;
/// Share of the cycle that a foot is planted. Walks of clean captures have 0.45–0.65, noisy ones label less, creeping
/// ones more; runners who turn tightly, at walking speed, have 0.38.
const WALKING_SHARE: [f32; 2] = [0.35, 0.8];
/// Runs of clean captures: 0.28–0.45; sprinters 0.22.
const RUNNING_SHARE: [f32; 2] = [0.22, 0.5];
/// Who stands lifts no foot for long.
const STANDING_SHARE: [f32; 2] = [0.9, 1.0];
/// The step over the seam, of angles and of velocities, over the cycle's own median step. Cycles without a visible
/// seam: up to 1.5 and 2.8; with one, from 3 and 9 on.
const SEAM_ANGLE_MAX: f32 = 2.0;
const SEAM_VELOCITY_MAX: f32 = 4.0;
/// Smaller steps than this are not seen, so a calmer median counts as this much: 0.05° a joint and row.
const SEAM_STEP_MIN_RAD: f32 = 0.05 * std::f32::consts::PI / 180.0;
/// The compiler lets a sole sink by 10 mm, as pads and shoes give; twice that is
/// seen, mm.
const PENETRATION_MAX_MM: f32 = 20.0;
/// People land on a knee flexed by 3–5°; straighter it snaps, degrees.
const KNEE_FLEXION_MIN_DEG: f32 = 1.0;
/// The compiler's leg inverse kinematics ends at 0.9995, a knee flexed by 3.6°; a longer leg came from a clip, hip to
/// ankle over thigh plus shank.
const LEG_EXTENSION_MAX: f32 = 0.9997;
/// Published ranges are of slow, unforced motion, and rigs share out a bend of the spine as they like: sound clips
/// exceed them by up to 42°, degrees.
const RANGE_EXCESS_MAX_DEG: f32 = 45.0;

/// The figures of one example.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExampleQuality {
    /// Its name.
    pub example: String,
    /// Mean speed of planted feet, cm/s.
    pub planted_slide_cm_s: f32,
    /// Share of the cycle that a foot is planted, mean of both.
    pub planted_share: f32,
    /// Root mean square over the joints of the turn from the last row to the first, over the median of all rows.
    pub seam_angle_ratio: f32,
    /// The same of the change of angular velocity, where that is greatest at the seam.
    pub seam_velocity_ratio: f32,
    /// How far a sole sinks below the ground, at most, mm.
    pub penetration_mm: f32,
    /// Least flexion of a knee, negative where it is hyperextended, degrees.
    pub knee_flexion_min_deg: f32,
    /// Greatest distance from hip to ankle over thigh plus shank.
    pub leg_extension_max: f32,
    /// How far a joint turns beyond the published range of people's, at most, degrees; 0 within.
    pub range_excess_deg: f32,
    /// The joint that does.
    pub range_excess_joint: &'static str,
}

/// A figure beyond its threshold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Whose.
    pub example: String,
    /// Which figure: its name in [`ExampleQuality`].
    pub measure: &'static str,
    /// What it is.
    pub value: f32,
    /// What it should not pass.
    pub threshold: f32,
    /// Unit of both; empty for ratios and shares.
    pub unit: &'static str,
    /// For people, without the example's name.
    pub sentence: String,
}

/// The slide of planted feet from which on it is suspect, of a body's speed over the ground, cm/s.
pub fn suspect_slide_cm_s(speed_mps: f32) -> f32 {
    SUSPECT_SLIDE_CM_S + SUSPECT_SLIDE_CM_S_PER_MPS * speed_mps
}

/// The figures of every example, in order. The database must be valid.
pub fn quality(db: &MotionDb) -> Vec<ExampleQuality> {
    (0..db.examples.len()).map(|example| example_quality(db, example)).collect()
}

/// Whatever lies beyond its threshold, in order of examples; mirrors repeat their originals and are passed over. The
/// database must be valid.
pub fn lint(db: &MotionDb) -> Vec<Finding> {
    let recorded = quality(db).into_iter().zip(&db.examples).filter(|(_, example)| !example.mirrored);
    recorded.flat_map(|(found, example)| findings(&found, example)).collect()
}

fn example_quality(db: &MotionDb, index: usize) -> ExampleQuality {
    let (example, joints) = (&db.examples[index], db.posed_rows(index));
    let [seam_angle_ratio, seam_velocity_ratio] = seam(&turns(db, index));
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

/// How each joint turns from each row to the next, the last to the first, as rotation vectors in the joint's frame.
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

/// The seam's step of angles, and of velocities into or out of it, over the medians of all steps.
fn seam(turns: &[[Vec3; JOINT_COUNT]]) -> [f32; 2] {
    let before = |row: usize| &turns[(row + PHASE_COUNT - 1) % PHASE_COUNT];
    let angles: Vec<f32> = turns.iter().map(|turn| rms(turn.iter().copied())).collect();
    let changes: Vec<f32> = (0..PHASE_COUNT)
        .map(|row| rms(turns[row].iter().zip(before(row)).map(|(after, before)| after - before)))
        .collect();
    let last = PHASE_COUNT - 1;
    [angles[last] / usual_step(&angles), changes[last].max(changes[0]) / usual_step(&changes)]
}

fn rms(vectors: impl Iterator<Item = Vec3>) -> f32 {
    libm::sqrtf(vectors.map(Vec3::length_squared).sum::<f32>() / JOINT_COUNT as f32)
}

fn usual_step(steps: &[f32]) -> f32 {
    let median = median(steps.iter().copied().map(f64::from)).unwrap_or_default() as f32;
    median.max(SEAM_STEP_MIN_RAD)
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

/// How far beyond its published range a joint turns, and which.
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

/// What lies beyond its thresholds.
fn findings(found: &ExampleQuality, example: &MotionExample) -> Vec<Finding> {
    let limits = contact_limits(found, example).into_iter().chain(seam_limits(found)).chain(body_limits(found));
    limits.filter_map(|limit| limit.finding(&found.example)).collect()
}

/// A figure, the range that it should lie in, and what to say where it does not.
struct Limit {
    measure: &'static str,
    unit: &'static str,
    value: f32,
    range: [f32; 2],
    sentence: String,
}

impl Limit {
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

fn contact_limits(found: &ExampleQuality, example: &MotionExample) -> [Limit; 2] {
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
        format!("planted feet slide by {slide_cm_s:.0} cm/s; at this speed they should by {slide_max_cm_s:.0} at most");
    let [has, from, to] = [share, least, most].map(|share| 100.0 * share);
    let planted =
        format!("a foot is planted for {has:.0} % of the cycle; {gait} clips should have {from:.0} to {to:.0} %");
    let limit = |measure, unit, value, range, sentence| Limit { measure, unit, value, range, sentence };
    [
        limit("planted_slide_cm_s", "cm/s", slide_cm_s, up_to(slide_max_cm_s), slide),
        limit("planted_share", "", share, [least, most], planted),
    ]
}

fn seam_limits(found: &ExampleQuality) -> [Limit; 2] {
    let [angle, velocity] = [found.seam_angle_ratio, found.seam_velocity_ratio];
    let limit =
        |measure, value, greatest, sentence| Limit { measure, unit: "", value, range: up_to(greatest), sentence };
    let jumps = format!("the pose jumps where the cycle closes, by {angle:.1} times a usual step");
    let jerks = format!("the motion jerks where the cycle closes, {velocity:.1} times as much as elsewhere");
    [
        limit("seam_angle_ratio", angle, SEAM_ANGLE_MAX, jumps),
        limit("seam_velocity_ratio", velocity, SEAM_VELOCITY_MAX, jerks),
    ]
}

fn body_limits(found: &ExampleQuality) -> [Limit; 4] {
    let (sunk_mm, flexed_deg) = (found.penetration_mm, found.knee_flexion_min_deg);
    let (joint, excess_deg) = (found.range_excess_joint, found.range_excess_deg);
    let limit = |measure, unit, value, range, sentence| Limit { measure, unit, value, range, sentence };
    let sinks = format!("a sole sinks {sunk_mm:.0} mm into the ground");
    let straightens = format!("a knee straightens to {flexed_deg:.1}° of flexion: it snaps or bends backward");
    let stretched = "a leg is stretched to its full length; it may be too short for the clip's steps".to_owned();
    let turns = format!("{joint} turns {excess_deg:.0}° beyond the range of people's");
    [
        limit("penetration_mm", "mm", sunk_mm, up_to(PENETRATION_MAX_MM), sinks),
        limit("knee_flexion_min_deg", "deg", flexed_deg, [KNEE_FLEXION_MIN_DEG, f32::INFINITY], straightens),
        limit("leg_extension_max", "", found.leg_extension_max, up_to(LEG_EXTENSION_MAX), stretched),
        limit("range_excess_deg", "deg", excess_deg, up_to(RANGE_EXCESS_MAX_DEG), turns),
    ]
}

//! A motion database made in code, for tests: idle, three walks, turns, side-steps and a step back, with analytic legs.
//!
//! A foot stands still for [`DUTY`] of each cycle while the root moves on along its arc: it lands on the heel, rolls
//! flat, and leaves over the ball; in between it swings on a cubic that meets both ends with their velocities.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3};
use motiondb::blend_space::BlendSpace;
use motiondb::body::{ExtraJoint, Foot, JOINT_COUNT, Joint, Pose, Side, Skeleton};
use motiondb::motion::{
    Correspondence, ExtraBone, ExtraMotion, MotionDb, MotionExample, PHASE_COUNT, Parameters, PhaseMap, Rows,
};
use motiondb::velocity_sets::velocity_hull::{self, Construction, VelocityHull};

use crate::synthesis::pose::ik::reach;
use crate::synthesis::pose::leg::{FootPose, legs};

/// Share of a cycle that a foot stands.
pub(crate) const DUTY: f32 = 0.6;
/// Where feet pass under the body, to the side, m.
const TRACK_M: f32 = 0.1;
const PELVIS_M: f32 = 0.86;
const HEEL_M: Vec3 = Vec3::new(-0.05, 0.0, -0.08);
const BALL_M: Vec3 = Vec3::new(0.13, 0.0, -0.08);

/// name, v_f, ω_t, ω_s, period; idle first.
const EXAMPLES: [(&str, f32, f32, f32, f32); 11] = [
    ("idle", 0.0, 0.0, 0.0, 1.1),
    ("walk_slow", 0.5, 0.0, 0.0, 1.25),
    ("walk", 1.0, 0.0, 0.0, 1.1),
    ("walk_fast", 1.5, 0.0, 0.0, 0.95),
    ("turn_left", 0.7, 1.2, 0.0, 1.15),
    ("turn_right", 0.7, -1.2, 0.0, 1.15),
    ("spin_left", 0.15, 2.6, 0.0, 1.2),
    ("spin_right", 0.15, -2.6, 0.0, 1.2),
    ("side_left", 0.0, 0.0, 0.5, 1.1),
    ("side_right", 0.0, 0.0, -0.5, 1.1),
    ("back", -0.6, 0.0, 0.0, 1.15),
];

/// Index of the example that is deformed, m_sp: `walk`.
const SEMI_PROCEDURAL: usize = 2;

/// The database.
pub(crate) fn test_db() -> MotionDb {
    let mut db = MotionDb {
        extra: ExtraMotion::default(),
        style: String::new(),
        further_styles: Vec::new(),
        skeleton: skeleton(),
        sources: Vec::new(),
        examples: EXAMPLES
            .iter()
            .map(|&(name, speed, turn, strafe, period)| example(name, [speed, turn, strafe], period))
            .collect(),
        rows: Rows::default(),
        velocity_hull: VelocityHull::default(),
        blend_space: BlendSpace::default(),
        correspondence: None,
        actions: Vec::new(),
    };
    for index in 0..db.examples.len() {
        append_rows(&mut db, index);
    }
    let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
    db.velocity_hull = velocity_hull::build(&parameters, Construction::default());
    db.blend_space = motiondb::blend_space::triangulation::build(&parameters);
    db.correspondence = Correspondence::of(&db, SEMI_PROCEDURAL);
    db
}

/// The database with two joints of the left index finger, which curl by [`curl_rad`].
pub(crate) fn db_with_fingers() -> MotionDb {
    let mut db = test_db();
    let bone = |joint: usize| ExtraBone { joint: ExtraJoint::finger(Side::Left, 1, joint), offset_m: Vec3::Y * 0.04 };
    db.extra.bones = [0, 1].map(bone).to_vec();
    let row = |example: usize, row: usize| curled(curl_rad(example, row as f32 / PHASE_COUNT as f32));
    let examples = 0..db.examples.len();
    db.extra.rotations = examples.flat_map(|example| (0..PHASE_COUNT).flat_map(move |at| row(example, at))).collect();
    db
}

/// Curl of the fingers of an example at a phase, rad: each example has a mean of its own.
pub(crate) fn curl_rad(example: usize, phase: f32) -> f32 {
    -0.2 - 0.1 * example as f32 - 0.15 * libm::sinf(TAU * phase)
}

/// Two finger joints that curl alike.
pub(crate) fn curled(angle_rad: f32) -> [Quat; 2] {
    [Quat::from_rotation_x(angle_rad); 2]
}

fn example(name: &str, [speed_mps, turn_rate_rad_s, strafe_mps]: [f32; 3], period_s: f32) -> MotionExample {
    let stands = name == "idle";
    MotionExample {
        name: name.into(),
        source: 0,
        window_s: [0.0, 1.0],
        mirrored: false,
        parameters: Parameters { speed_mps, turn_rate_rad_s, strafe_mps },
        phase_map: PhaseMap { period_s, left_share: if stands { 0.5 } else { 0.53 } },
        key_times_s: (!stands).then(|| [0.3, 0.7, 0.8, 0.2].map(|phase| phase * period_s)),
        planted_slide_cm_s: 0.0,
        planted_share: DUTY,
    }
}

fn append_rows(db: &mut MotionDb, index: usize) {
    let example = db.examples[index].clone();
    for row in 0..PHASE_COUNT {
        let phase = row as f32 / PHASE_COUNT as f32;
        let feet = [0, 1].map(|side| foot(&example, phase, side));
        let mut pose = Pose { pelvis_m: Vec3::new(0.0, 0.0, PELVIS_M), rotations: [Quat::IDENTITY; JOINT_COUNT] };
        let mut legs = legs(&pose, &db.skeleton);
        for (side, (target, toe_bend_rad, _)) in feet.iter().enumerate() {
            pose.rotations[Joint::TOES[side].index()] = Quat::from_rotation_y(-toe_bend_rad);
            reach(&mut pose, &mut legs[side], &db.skeleton, side, target);
        }
        db.rows.pelvis_m.push(pose.pelvis_m);
        db.rows.rotations.extend(pose.rotations.map(|rotation| if rotation.w < 0.0 { -rotation } else { rotation }));
        db.rows.contacts.push([feet[0].2, feet[1].2]);
    }
}

/// Target, toe bend and contact of one foot.
fn foot(example: &MotionExample, phase: f32, side: usize) -> (FootPose, f32, f32) {
    if example.key_times_s.is_none() {
        return (stance(example, 0.0, side, 0.0), 0.0, 1.0);
    }
    let middle = if side == 0 { 0.5 } else { 0.0 };
    let offset = (phase - middle + 0.5).rem_euclid(1.0) - 0.5;
    let contact = (0.5 + (0.5 * DUTY - offset.abs()) / 0.04).clamp(0.0, 1.0);
    if offset.abs() <= 0.5 * DUTY {
        let pitch = pitch_rad(offset / (0.5 * DUTY));
        return (stance(example, time_from_s(example, middle, offset), side, pitch), pitch.max(0.0), contact);
    }
    let share = (if offset > 0.0 { offset } else { offset + 1.0 } - 0.5 * DUTY) / (1.0 - DUTY);
    let (target, pitch) = swing(example, middle, share, side);
    (target, pitch.max(0.0), contact)
}

fn time_from_s(example: &MotionExample, middle: f32, offset: f32) -> f32 {
    example.phase_map.time_s(middle + offset) - example.phase_map.time_s(middle)
}

/// Heel down first, heel up last; `position` from −1 at landing to 1 at toe-off.
fn pitch_rad(position: f32) -> f32 {
    let landing = (-0.5 - position).max(0.0) / 0.5;
    let leaving = (position - 0.2).max(0.0) / 0.8;
    -0.25 * landing * landing + 0.6 * leaving * leaving
}

/// A standing foot, a time after mid-stance.
fn stance(example: &MotionExample, time_s: f32, side: usize, pitch_rad: f32) -> FootPose {
    let turned = Quat::from_rotation_z(-example.parameters.turn_rate_rad_s * time_s);
    let pivot = if pitch_rad < 0.0 { HEEL_M } else { BALL_M };
    let at_middle = Vec3::new(0.0, if side == 0 { TRACK_M } else { -TRACK_M }, 0.08);
    let root = arc_m(&example.parameters, time_s).extend(0.0);
    let pitched = Quat::from_rotation_y(pitch_rad);
    let orientation = turned * pitched;
    FootPose { ankle_m: turned * (at_middle + pivot - root - pitched * pivot), orientation }
}

/// Where the root gets in a time.
fn arc_m(parameters: &Parameters, time_s: f32) -> Vec2 {
    let half = 0.5 * parameters.turn_rate_rad_s * time_s;
    let chord = if half.abs() > 1e-4 { libm::sinf(half) / half } else { 1.0 };
    Vec2::from_angle(half).rotate(parameters.velocity_mps()) * time_s * chord
}

/// A swinging foot, `share` of its swing done.
fn swing(example: &MotionExample, middle: f32, share: f32, side: usize) -> (FootPose, f32) {
    let end = |sign: f32, phase: f32| stance(example, time_from_s(example, middle, phase), side, pitch_rad(sign));
    let (from, to) = (end(1.0, 0.5 * DUTY), end(-1.0, -0.5 * DUTY));
    let small = 1e-3;
    let from_speed = (from.ankle_m - end(1.0, 0.5 * DUTY - small).ankle_m) / small * (1.0 - DUTY);
    let to_speed = (end(-1.0, small - 0.5 * DUTY).ankle_m - to.ankle_m) / small * (1.0 - DUTY);
    let (s2, s3) = (share * share, share * share * share);
    let lift = Vec3::new(0.0, 0.0, 0.08 * (0.5 - 0.5 * libm::cosf(TAU * share)));
    let ankle_m = from.ankle_m * (2.0 * s3 - 3.0 * s2 + 1.0)
        + to.ankle_m * (3.0 * s2 - 2.0 * s3)
        + from_speed * (s3 - 2.0 * s2 + share)
        + to_speed * (s3 - s2)
        + lift;
    let smooth = 3.0 * s2 - 2.0 * s3;
    let pitch = pitch_rad(1.0) + (pitch_rad(-1.0) - pitch_rad(1.0)) * smooth;
    (FootPose { ankle_m, orientation: from.orientation.slerp(to.orientation, smooth) }, pitch)
}

/// A person of 1.7 m in round numbers.
pub(crate) fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::new(0.0, 0.0, 0.12); JOINT_COUNT];
    offsets_m[Joint::Pelvis.index()] = Vec3::new(0.0, 0.0, 0.92);
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        offsets_m[Joint::THIGHS[side].index()] = Vec3::new(0.0, sign * TRACK_M, 0.0);
        offsets_m[Joint::SHANKS[side].index()] = Vec3::new(0.0, 0.0, -0.42);
        offsets_m[Joint::FEET[side].index()] = Vec3::new(0.0, 0.0, -0.42);
        offsets_m[Joint::TOES[side].index()] = BALL_M;
        offsets_m[Joint::UPPER_ARMS[side].index()] = Vec3::new(0.0, sign * 0.16, 0.0);
    }
    let toe_tip_m = Vec3::new(0.06, 0.0, 0.0);
    let foot = Foot { heel_m: HEEL_M, ball_m: BALL_M, toe_tip_m, measured_m: [HEEL_M, BALL_M, toe_tip_m] };
    Skeleton {
        segment_ends_m: offsets_m,
        offsets_m,
        segment_radii_m: [0.05; JOINT_COUNT],
        limits_rad: [[Vec3::splat(-3.0), Vec3::splat(3.0)]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

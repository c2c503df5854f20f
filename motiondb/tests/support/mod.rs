//! A small database that is written by hand: a body on two stiff legs stands, walks and turns.
//!
//! The ankle of a planted foot keeps its position in the world as the root moves along its arc. The ankle of the other
//! foot swings forward in a straight line.

use glam::{Quat, Vec2, Vec3};
use motiondb::blend_space::BlendSpace;
use motiondb::body::{ExtraJoint, Foot, JOINT_COUNT, Joint, Root, Side, Skeleton};
use motiondb::diagnostic::{Diagnostic, Note, Warning};
use motiondb::motion::{
    Action, ActionEnd, ActionFrame, ActionKind, Correspondence, ExtraBone, ExtraMotion, MotionDb, MotionExample,
    PHASE_COUNT, Parameters, PhaseMap, Rows, SourceRecord,
};
use motiondb::quality::planted_feet::{CycleFeet, foot_slide};
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};

/// Length of thigh plus shank, metres.
const LEG_M: f32 = 0.84;
/// Number of rows before and after its mid-stance in which a foot is planted.
const STANCE_ROWS: i32 = 19;

/// Standing, a walk and a walking turn.
pub(crate) fn small_db() -> MotionDb {
    let parameters = [[0.0, 0.0, 0.0], [1.2, 0.0, 0.0], [0.8, 1.0, 0.0]];
    let names = ["stand", "turn_none", "turn_one"];
    let examples: Vec<MotionExample> = names.iter().zip(parameters).map(|(name, at)| example(name, at)).collect();
    let mut db = MotionDb {
        extra: ExtraMotion::default(),
        style: String::new(),
        further_styles: Vec::new(),
        skeleton: skeleton(),
        sources: vec![source()],
        rows: rows(&examples),
        velocity_hull: VelocityHull {
            construction: Construction::default(),
            turning_mps: vec![Vec2::ZERO, Vec2::new(0.8 * libm::cosf(1.0), 0.8 * libm::sinf(1.0)), Vec2::new(1.2, 0.0)],
            holding_mps: vec![Vec2::ZERO, Vec2::new(1.2, 0.0)],
            sharp_turn_edges_mps: Vec::new(),
        },
        blend_space: BlendSpace {
            dimension: 2,
            axis_ranges: [1.2, 1.0, 0.0],
            simplices: vec![0, 1, 2],
            covered_share: 1.0,
        },
        correspondence: Some(Correspondence {
            semi_procedural: 1,
            blending: 2,
            pairs_s: vec![[0.2, 0.8], [0.4, 0.1], [0.9, 0.6]],
        }),
        examples,
        actions: Vec::new(),
    };
    db.actions = vec![action(&db, ActionKind::Idle, 60), action(&db, ActionKind::Start, 72)];
    (0..db.examples.len()).for_each(|index| measure(&mut db, index));
    db
}

/// The small database with two joints of the left index finger, which curl in proportion to the phase and the frame.
#[allow(dead_code, reason = "each test file compiles this module for itself")]
pub(crate) fn db_with_fingers() -> MotionDb {
    let mut db = small_db();
    let bone = |joint: usize| ExtraBone { joint: ExtraJoint::finger(Side::Left, 1, joint), offset_m: Vec3::Y * 0.04 };
    let curl = |step: usize| [Quat::from_rotation_x(-0.01 * step as f32); 2];
    db.extra = ExtraMotion {
        bones: [0, 1].map(bone).to_vec(),
        rotations: (0..db.examples.len()).flat_map(|_| (0..PHASE_COUNT).flat_map(curl)).collect(),
        actions: db.actions.iter().map(|action| (0..action.frames.len()).flat_map(curl).collect()).collect(),
    };
    db
}

fn example(name: &str, [speed_mps, turn_rate_rad_s, strafe_mps]: [f32; 3]) -> MotionExample {
    MotionExample {
        name: name.into(),
        source: 0,
        window_s: [0.0, 1.0],
        mirrored: false,
        parameters: Parameters { speed_mps, turn_rate_rad_s, strafe_mps },
        phase_map: PhaseMap { period_s: 1.0, left_share: 0.5 },
        key_times_s: None,
        planted_slide_cm_s: 0.0,
        planted_share: 1.0,
    }
}

/// An action of the standing pose, whose root moves as its kind requires.
fn action(db: &MotionDb, kind: ActionKind, last: usize) -> Action {
    let end = |stands: bool| ActionEnd { example: u32::from(!stands), phase: 0.0 };
    let [entry, exit] = kind.stands().map(end);
    let root = |frame: usize| {
        // A cubic from rest to the speed of the walk.
        let (share, duration_s) = (frame as f32 / last as f32, last as f32 / 60.0);
        let speed_mps = db.examples[exit.example as usize].parameters.speed_mps;
        Root { position_m: Vec2::X * speed_mps * duration_s * 0.5 * share * share, facing_rad: 0.0 }
    };
    let frame = |frame: usize| ActionFrame { pose: db.rows.pose(0, 0), contacts: [1.0; 2], root: root(frame) };
    let frames = (0..=last).map(frame).collect();
    Action { name: kind.name().into(), kind, source: 0, window_s: [0.0, 1.0], mirrored: false, entry, exit, frames }
}

/// Fills in slide, planted share and key times from the rows.
fn measure(db: &mut MotionDb, index: usize) {
    let feet = CycleFeet::of(db, index, &db.posed_rows(index));
    let example = &mut db.examples[index];
    let slide = foot_slide(&feet, example.parameters.to_vec3().as_dvec3());
    (example.planted_slide_cm_s, example.planted_share) = (slide.slide_cm_s as f32, slide.planted_share as f32);
    let time_s = |phase: f64| example.phase_map.time_s(phase.rem_euclid(1.0) as f32);
    let stances = [Side::Right, Side::Left].map(|side| feet.stance(side));
    if let [Some([right_lands, right_leaves]), Some([left_lands, left_leaves])] = stances {
        example.key_times_s = Some([right_leaves, right_lands, left_leaves, left_lands].map(time_s));
    }
}

fn source() -> SourceRecord {
    SourceRecord {
        file: "walk.bvh".into(),
        clip: String::new(),
        speed_mps: 1.2,
        turn_rate_rad_s: 0.0,
        strafe_mps: 0.0,
        up_axis: "+Y".into(),
        metres_per_unit: 0.01,
        frame_rate_hz: 30.0,
        diagnostics: vec![
            Diagnostic::Note(Note::FirstPoseCut),
            Diagnostic::Warning(Warning::FeetSlide { slide_cm_s: 12.5, from_s: None }),
        ],
    }
}

fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::new(0.0, 0.0, 0.1); JOINT_COUNT];
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        offsets_m[Joint::THIGHS[side].index()] = Vec3::new(0.0, sign * 0.1, 0.0);
        offsets_m[Joint::SHANKS[side].index()] = Vec3::new(0.0, 0.0, -0.5 * LEG_M);
        offsets_m[Joint::FEET[side].index()] = Vec3::new(0.0, 0.0, -0.5 * LEG_M);
        offsets_m[Joint::TOES[side].index()] = Vec3::ZERO;
    }
    let foot = Foot { heel_m: Vec3::ZERO, ball_m: Vec3::ZERO, toe_tip_m: Vec3::ZERO, measured_m: [Vec3::ZERO; 3] };
    Skeleton {
        offsets_m,
        segment_ends_m: offsets_m,
        segment_radii_m: [0.05; JOINT_COUNT],
        limits_rad: [[Vec3::NEG_ONE, Vec3::ONE]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

fn rows(examples: &[MotionExample]) -> Rows {
    let mut rows = Rows::default();
    for (example, row) in examples.iter().flat_map(|example| (0..PHASE_COUNT).map(move |row| (example, row))) {
        let legs = [0, 1].map(|side| leg(example, row as i32, side));
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        for (side, (swing, _)) in legs.iter().enumerate() {
            rotations[Joint::THIGHS[side].index()] = *swing;
            rotations[Joint::FEET[side].index()] = swing.inverse();
        }
        rows.rotations.extend(rotations);
        rows.pelvis_m.push(Vec3::new(0.0, 0.0, LEG_M));
        rows.contacts.push(legs.map(|(_, contact)| contact));
    }
    rows
}

/// Rotation of a leg in a row, and the contact of its foot.
fn leg(example: &MotionExample, row: i32, side: usize) -> (Quat, f32) {
    if example.parameters == Parameters::default() {
        return (Quat::IDENTITY, 1.0);
    }
    let (rows, half) = (PHASE_COUNT as i32, PHASE_COUNT as i32 / 2);
    let since_middle = (row + if side == 0 { 0 } else { half }).rem_euclid(rows) - half;
    let planted_m = |rows: i32| planted_ankle_m(example, rows as f32 / PHASE_COUNT as f32, side);
    let is_planted = since_middle.abs() <= STANCE_ROWS;
    let ankle_m = if is_planted {
        planted_m(since_middle)
    } else {
        let share = (since_middle - STANCE_ROWS).rem_euclid(rows) as f32 / (rows - 2 * STANCE_ROWS) as f32;
        planted_m(STANCE_ROWS).lerp(planted_m(-STANCE_ROWS), share)
    };
    let along_m = ankle_m.extend(-(LEG_M * LEG_M - ankle_m.length_squared()).sqrt());
    (Quat::from_rotation_arc(Vec3::NEG_Z, along_m / LEG_M), f32::from(u8::from(is_planted)))
}

/// Position of a planted ankle relative to its hip, a time after mid-stance, metres.
fn planted_ankle_m(example: &MotionExample, time_s: f32, side: usize) -> Vec2 {
    let hip_m = Vec2::new(0.0, if side == 0 { 0.1 } else { -0.1 });
    let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = example.parameters;
    let half_rad = 0.5 * turn_rate_rad_s * time_s;
    let chord = if half_rad == 0.0 { 1.0 } else { libm::sinf(half_rad) / half_rad };
    let root_m = Vec2::from_angle(half_rad).rotate(Vec2::new(speed_mps, strafe_mps)) * time_s * chord;
    Vec2::from_angle(-2.0 * half_rad).rotate(hip_m - root_m) - hip_m
}

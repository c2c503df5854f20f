//! Semi-procedural locomotion: one cycle walks with any parameters, and its planted feet hold.

use std::f32::consts::TAU;

use fbcrowd_sim::synthesis::semi_procedural::BaseWalk;
use fbcrowd_sim::synthesis::semi_procedural::Deformation;
use glam::Vec2;
use motiondb::body::Joint;
use motiondb::body::Joints;
use motiondb::motion::MotionDb;
use motiondb::motion::Parameters;
use motiondb::quality::planted_feet::{CycleFeet, PLANTED_CONTACT, foot_slide, implied_root_motion};

use super::clips::{bundled, marine};

/// Gaits: v_f m/s, ω_t °/s, ω_s m/s.
const GAITS: [[f32; 3]; 22] = [
    [0.2, 0.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.8, 0.0, 0.0],
    [1.4, 0.0, 0.0],
    [1.8, 0.0, 0.0],
    [2.2, 0.0, 0.0],
    [0.9, 60.0, 0.0],
    [0.9, -60.0, 0.0],
    [0.7, 90.0, 0.0],
    [0.5, -130.0, 0.0],
    [0.0, 90.0, 0.0],
    [0.0, -170.0, 0.0],
    [0.0, 0.0, 0.35],
    [0.0, 0.0, -0.6],
    [0.0, 0.0, 1.2],
    [0.8, 0.0, 0.4],
    [1.1, 0.0, -0.3],
    [-0.4, 0.0, 0.0],
    [-0.8, 0.0, 0.0],
    [-1.1, 0.0, 0.0],
    [-0.6, 45.0, 0.0],
    [-0.5, 0.0, -0.4],
];

struct Cycle {
    parameters: Parameters,
    cadence: f32,
    joints: Vec<Joints>,
    feet: CycleFeet,
}

fn parameters([speed_mps, turn_rate_deg_s, strafe_mps]: [f32; 3]) -> Parameters {
    Parameters { speed_mps, turn_rate_rad_s: turn_rate_deg_s.to_radians(), strafe_mps }
}

fn semi_procedural(db: &MotionDb) -> BaseWalk {
    BaseWalk::new(db, db.correspondence.as_ref().unwrap().semi_procedural as usize).unwrap()
}

fn cycle(db: &MotionDb, semi: &BaseWalk, parameters: Parameters) -> Cycle {
    let deformation = Deformation::new(semi, parameters);
    let (joints, feet) = deformation.measurable(&db.skeleton, &deformation.cycle(db));
    Cycle { parameters, cadence: semi.cadence(parameters), joints, feet }
}

fn cycles(db: &MotionDb) -> Vec<Cycle> {
    let semi = semi_procedural(db);
    GAITS.iter().map(|&gait| cycle(db, &semi, parameters(gait))).collect()
}

/// Share of the travel to the side. There a foot's roll and its reverse are averaged: the foot hold removes the slip as
/// the contact passes from heel to ball.
fn aside(parameters: Parameters) -> f32 {
    let travel_mps = libm::hypotf(parameters.speed_mps, parameters.strafe_mps);
    parameters.strafe_mps.abs() / travel_mps.max(f32::MIN_POSITIVE)
}

/// Deformed to its own parameters, m_sp stays as it is.
fn check_own_parameters(db: &MotionDb) {
    let semi = semi_procedural(db);
    let own = cycle(db, &semi, db.examples[semi.example].parameters);
    for (deformed, recorded) in own.joints.iter().zip(db.posed_rows(semi.example)) {
        for (a, b) in deformed.positions_m.iter().zip(recorded.positions_m) {
            // An almost straight knee is bent by one degree.
            assert!(a.distance(b) < 4e-3, "{a} {b}");
        }
    }
}

#[test]
fn m_sp_keeps_its_own_parameters() {
    check_own_parameters(&bundled());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn m_sp_keeps_its_own_parameters_with_real_clips() {
    check_own_parameters(&marine());
}

/// Planted feet hold at every speed, direction and turn rate.
fn check_planted_feet(db: &MotionDb) {
    let source_cm_s = db.examples[semi_procedural(db).example].planted_slide_cm_s;
    for cycle in cycles(db) {
        let slide = foot_slide(&cycle.feet, cycle.parameters.to_vec3().as_dvec3());
        let limit_cm_s = f64::from(cycle.cadence * (source_cm_s + 0.1 + 1.4 * aside(cycle.parameters)));
        assert!(slide.slide_cm_s <= limit_cm_s, "{:?}: {slide:?}, {limit_cm_s} cm/s", cycle.parameters);
        assert!((0.55..0.7).contains(&slide.planted_share), "{:?}: {slide:?}", cycle.parameters);
    }
}

#[test]
fn planted_feet_hold_with_all_parameters() {
    check_planted_feet(&bundled());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn planted_feet_hold_with_all_parameters_with_real_clips() {
    check_planted_feet(&marine());
}

#[test]
fn the_feet_imply_the_parameters() {
    for cycle in cycles(&bundled()) {
        let found = implied_root_motion(&cycle.feet).unwrap().parameters;
        let off = found.to_vec3() - cycle.parameters.to_vec3();
        let turn_limit_rad_s = cycle.cadence * (0.2 + 1.0 * aside(cycle.parameters)).to_radians();
        let off_mps = off.x.abs().max(off.z.abs());
        assert!(off_mps < 0.005 && off.y.abs() < turn_limit_rad_s, "{off} {:?}", cycle.parameters);
    }
}

#[test]
fn legs_neither_cross_nor_overstretch() {
    let db = bundled();
    for cycle in cycles(&db) {
        for joints in &cycle.joints {
            let [left_m, right_m] = Joint::FEET.map(|foot| joints.positions_m[foot.index()]);
            assert!(left_m.y - right_m.y > 0.04, "{:?}: {left_m} {right_m}", cycle.parameters);
            let soles_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side));
            let lowest_m = soles_m.iter().flatten().fold(f32::INFINITY, |low, point_m| low.min(point_m.z));
            assert!(lowest_m > -0.005, "{:?}: {lowest_m} m", cycle.parameters);
            for side in 0..2 {
                let flexion_deg = knee_flexion_deg(joints, side);
                assert!(flexion_deg > 3.0, "{:?}: {flexion_deg}°", cycle.parameters);
            }
        }
    }
}

#[test]
fn slow_steps_are_upright_and_clear_the_ground() {
    let db = bundled();
    let semi = semi_procedural(&db);
    for gait in [[0.1, 0.0, 0.0], [0.3, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0, 90.0, 0.0]] {
        let Cycle { joints, feet, .. } = cycle(&db, &semi, parameters(gait));
        let stands = |row: &usize| feet.contacts.iter().all(|contacts| contacts[*row] >= PLANTED_CONTACT);
        let on_both: Vec<&Joints> = (0..joints.len()).filter(stands).map(|row| &joints[row]).collect();
        let flexion_deg = |joints: &&Joints| 0.5 * (knee_flexion_deg(joints, 0) + knee_flexion_deg(joints, 1));
        let mean_deg = on_both.iter().map(flexion_deg).sum::<f32>() / on_both.len() as f32;
        assert!(mean_deg < 22.0, "{gait:?}: knees are flexed by {mean_deg}°");
        for side in 0..2 {
            let lowest_m = |joints: &Joints| {
                joints.sole_points_m(&db.skeleton, side).iter().map(|point_m| point_m.z).fold(f32::INFINITY, f32::min)
            };
            let clearance_m = joints.iter().map(lowest_m).fold(0.0, f32::max);
            assert!(clearance_m > 0.015, "{gait:?}: {clearance_m} m");
        }
    }
}

/// Greatest vertical acceleration of the hips, m/s², row by row.
fn hips_mps2(cycle: &Cycle) -> f32 {
    let row_s = cycle.feet.phase_map.period_s / cycle.joints.len() as f32;
    let at_m = |row: usize| cycle.joints[row % cycle.joints.len()].positions_m[0].z;
    let rows = 0..cycle.joints.len();
    rows.map(|row| (at_m(row) - 2.0 * at_m(row + 1) + at_m(row + 2)).abs() / (row_s * row_s)).fold(0.0, f32::max)
}

#[test]
fn hips_accelerate_no_more_than_the_stride_does() {
    for cycle in cycles(&bundled()).into_iter().filter(|cycle| cycle.parameters.speed_mps < 2.0) {
        let (speed, swing_rad_s) = (cycle.parameters.speed_mps / 1.4, 2.0 * TAU / cycle.feet.phase_map.period_s);
        // Amplitude of a swing twice a stride, m; people's hips swing by 2 to 3 cm.
        let swing_m = 0.06 * (speed * speed).max(1.0);
        let limit_mps2 = swing_m * swing_rad_s * swing_rad_s;
        assert!(hips_mps2(&cycle) < limit_mps2, "{:?}: {} of {limit_mps2}", cycle.parameters, hips_mps2(&cycle));
    }
}

fn knee_flexion_deg(joints: &Joints, side: usize) -> f32 {
    let [hip_m, knee_m, ankle_m] =
        [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(|joint| joints.positions_m[joint.index()]);
    (knee_m - hip_m).angle_between(ankle_m - knee_m).to_degrees()
}

#[test]
fn a_gait_reversed_beyond_its_end_keeps_its_contacts() {
    let db = bundled();
    let semi = semi_procedural(&db);
    let back = parameters([-0.3, 0.0, 0.0]);
    let contacts = |travel| Deformation::travelling(&semi, back, travel, 1.0).contacts(&db, 0.3);
    assert_eq!(contacts(Vec2::new(-1.4, 0.0)), contacts(Vec2::NEG_X));
}

#[test]
fn extreme_parameters_give_finite_poses() {
    let db = bundled();
    let semi = semi_procedural(&db);
    for gait in [[0.0; 3], [9.0, 0.0, 0.0], [-9.0, 2000.0, 7.0], [0.0, -4000.0, 0.0], [0.0, 0.0, 50.0]] {
        let cycle = cycle(&db, &semi, parameters(gait));
        assert!(cycle.joints.iter().all(|joints| joints.positions_m.iter().all(|at_m| at_m.is_finite())));
    }
}

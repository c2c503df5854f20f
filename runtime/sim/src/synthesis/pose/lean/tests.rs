//! Whole bodies that lean, on the analytic database of [`crate::test_db`] and on sets made of it.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use motiondb::blend_space::triangulation;
use motiondb::body::{JOINT_COUNT, Joint, Root};
use motiondb::motion::{Correspondence, MotionDb, PHASE_COUNT, Parameters};

use crate::planning::plan::Plan;
use crate::synthesis::command::plan_requesting;
use crate::synthesis::pose::lean::ExcessLean;
use crate::synthesis::pose::lean::balance::lean_in_curve_rad;
use crate::synthesis::pose::lean::incline::TRUNK_SHARE;
use crate::synthesis::pose::posture::Posture;
use crate::synthesis::{Body, HmsParams, Modes, SynthesisContext};
use crate::test_db::test_db;

const DT_S: f32 = 1.0 / 60.0;
/// Steps after which a body moves steadily.
const STEADY_FROM: usize = 300;

/// The examples of a set by name, of which the last is m_sp.
fn set_of(db: &MotionDb, names: &[&str]) -> MotionDb {
    let mut set = MotionDb { examples: Vec::new(), rows: Default::default(), ..db.clone() };
    for name in names {
        let example = db.examples.iter().position(|example| example.name == *name).unwrap();
        let rows = example * PHASE_COUNT..(example + 1) * PHASE_COUNT;
        let rotations = rows.start * JOINT_COUNT..rows.end * JOINT_COUNT;
        set.rows.pelvis_m.extend_from_slice(&db.rows.pelvis_m[rows.clone()]);
        set.rows.contacts.extend_from_slice(&db.rows.contacts[rows]);
        set.rows.rotations.extend_from_slice(&db.rows.rotations[rotations]);
        set.examples.push(db.examples[example].clone());
    }
    let parameters: Vec<Parameters> = set.examples.iter().map(|example| example.parameters).collect();
    set.blend_space = triangulation::build(&parameters);
    set.correspondence = Correspondence::of(&set, names.len() - 1);
    set
}

/// The database with examples that lean into their curves, as captured circles do.
fn leaning() -> MotionDb {
    let mut db = test_db();
    for example in 0..db.examples.len() {
        let drawn = db.examples[example].parameters;
        let body_rad = lean_in_curve_rad(&drawn);
        let [body_rad, trunk_rad] =
            [body_rad, TRUNK_SHARE * body_rad].map(|tilt_rad| [tilt_rad, Vec2::ZERO, Vec2::ZERO]);
        let lean = ExcessLean { drawn, body_rad, trunk_rad };
        for row in 0..PHASE_COUNT {
            let mut posture = Posture::new(db.rows.pose(example, row), [1.0; 2], &db.skeleton);
            lean.lean(&mut posture, &db.skeleton);
            posture.bend_legs(&db.skeleton);
            let at = example * PHASE_COUNT + row;
            db.rows.pelvis_m[at] = posture.pose.pelvis_m;
            db.rows.rotations[at * JOINT_COUNT..(at + 1) * JOINT_COUNT].copy_from_slice(&posture.pose.rotations);
        }
    }
    db
}

/// What is observed of a body, and of the axis of its pelvis, that moves steadily at some parameters.
fn steady<T>(db: &MotionDb, modes: Modes, requested: Parameters, observe: impl Fn(&Body, Vec3) -> T) -> Vec<T> {
    let params = HmsParams { modes, ..HmsParams::default() };
    let context = SynthesisContext::new(Arc::new(db.clone()), params.clone());
    let plan = |_: f32, root: &Root| plan_requesting(requested, root, &params);
    let mut observed = context.walk_alone(0.3, 12.0, DT_S, plan, |body, output| {
        let joints = output.pose.forward_kinematics(&context.db.skeleton);
        observe(body, joints.orientations[Joint::Pelvis.index()] * Vec3::Z)
    });
    observed.split_off(STEADY_FROM)
}

/// Mean lean of the pelvis to the left, degrees. That of the test database is upright.
fn lean_deg(db: &MotionDb, modes: Modes, requested: Parameters) -> f32 {
    let up: Vec3 = steady(db, modes, requested, |_, up| up).into_iter().sum();
    libm::atan2f(up.y, up.z).to_degrees()
}

fn curve(speed_mps: f32, turn_rate_rad_s: f32) -> Parameters {
    Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 }
}

#[test]
fn examples_at_their_own_parameters_lean_no_further() {
    for example in test_db().examples {
        let excess_rad = |body: &Body, _: Vec3| body.lean.body_rad[0].length() + body.lean.trunk_rad[0].length();
        let excess_rad = steady(&test_db(), Modes::Blending, example.parameters, excess_rad);
        let greatest_rad = excess_rad.into_iter().fold(0.0, f32::max);
        assert!(greatest_rad < 1e-3, "{}: {greatest_rad} rad", example.name);
    }
}

#[test]
fn a_straight_walk_of_circles_alone_is_upright() {
    let db = leaning();
    for names in [&["turn_left", "turn_right"][..], &["turn_right", "turn_left"], &["spin_left", "turn_left"]] {
        for modes in [Modes::Blending, Modes::Hybrid] {
            let lean_deg = lean_deg(&set_of(&db, names), modes, curve(0.7, 0.0));
            assert!(lean_deg.abs() < 2.0, "{names:?}, {modes:?}: {lean_deg}°");
        }
    }
}

#[test]
fn bodies_with_straight_clips_lean_into_curves() {
    let db = set_of(&test_db(), &["idle", "walk_slow", "walk"]);
    for modes in [Modes::Blending, Modes::SemiProcedural] {
        for turn_rate_rad_s in [1.0, -1.0] {
            let requested = curve(0.9, turn_rate_rad_s);
            let expected_deg = lean_in_curve_rad(&requested).y.to_degrees();
            let lean_deg = lean_deg(&db, modes, requested);
            assert!((lean_deg - expected_deg).abs() < 1.0, "{modes:?}: {lean_deg}° instead of {expected_deg}°");
        }
    }
}

#[test]
fn a_walk_mixed_with_a_spin_leans_into_its_curve() {
    let db = set_of(&leaning(), &["spin_left", "spin_right", "walk_slow", "walk_fast", "walk"]);
    let requested = curve(0.7, 1.2);
    let lean_deg = lean_deg(&db, Modes::Blending, requested);
    let expected_deg = lean_in_curve_rad(&requested).y.to_degrees();
    assert!((lean_deg - expected_deg).abs() < 1.0, "{lean_deg}° instead of {expected_deg}°");
}

#[test]
fn the_drawn_trunk_leans_with_every_synthesis() {
    for modes in [Modes::Blending, Modes::Hybrid] {
        let context = SynthesisContext::new(Arc::new(test_db()), HmsParams { modes, ..HmsParams::default() });
        let plan = |time_s: f32, _: &Root| Plan {
            velocity_mps: Vec2::new(if (1.0..4.0).contains(&time_s) { 1.3 } else { 0.0 }, 0.0),
            ..Plan::default()
        };
        let forward_m = context.walk_alone(0.3, 6.0, 1.0 / 60.0, plan, |_, output| {
            let joints = output.pose.forward_kinematics(&context.db.skeleton);
            (joints.positions_m[Joint::Neck.index()] - joints.positions_m[Joint::Pelvis.index()]).x
        });
        let mean_m = |from: usize, to: usize| forward_m[from..to].iter().sum::<f32>() / (to - from) as f32;
        let (start_m, walk_m, stop_m) = (mean_m(66, 96), mean_m(150, 230), mean_m(246, 276));
        assert!(start_m > walk_m + 0.01 && stop_m < walk_m - 0.01, "{start_m} {walk_m} {stop_m} m");
    }
}

//! The root motion that planted feet imply, and the measures of quality.

mod support;

use glam::{DVec2, DVec3, Quat};
use motiondb::body::{JOINT_COUNT, Joint, Side};
use motiondb::motion::{Action, MotionDb, PHASE_COUNT};
use motiondb::quality::action_quality;
use motiondb::quality::example_quality::{lint, quality};
use motiondb::quality::planted_feet::{CycleFeet, foot_slide, implied_root_motion, implied_velocity_mps};
use support::small_db;

const WALK: usize = 1;
const TURN: usize = 2;

fn feet(db: &MotionDb, example: usize) -> CycleFeet {
    CycleFeet::of(db, example, &db.posed_rows(example))
}

#[test]
fn planted_feet_imply_the_root_motion() {
    let db = small_db();
    for example in [WALK, TURN] {
        let (found, stored) = (implied_root_motion(&feet(&db, example)).unwrap(), db.examples[example].parameters);
        assert!(found.parameters.to_vec3().distance(stored.to_vec3()) < 2e-3, "{found:?}, not {stored:?}");
        assert!(found.rest_mps < 1e-3, "{found:?}");
    }
}

#[test]
fn planted_feet_imply_the_velocity_at_a_turn_rate() {
    let db = small_db();
    for example in [WALK, TURN] {
        let stored = db.examples[example].parameters;
        let found_mps = implied_velocity_mps(&feet(&db, example), stored.turn_rate_rad_s.into()).unwrap();
        let stored_mps = DVec2::new(stored.speed_mps.into(), stored.strafe_mps.into());
        assert!(found_mps.distance(stored_mps) < 2e-3, "{found_mps}, not {stored_mps}");
    }
}

#[test]
fn a_wrong_root_motion_makes_feet_slide() {
    let db = small_db();
    let (feet, off_mps) = (feet(&db, TURN), DVec3::new(0.1, 0.0, 0.0));
    let velocity = db.examples[TURN].parameters.to_vec3().as_dvec3();
    assert!(foot_slide(&feet, velocity).slide_cm_s < 0.05);
    assert!((foot_slide(&feet, velocity + off_mps).slide_cm_s - 10.0).abs() < 0.1);
    assert!((implied_root_motion(&feet).unwrap().misfit_mps(&feet, velocity + off_mps) - 0.1).abs() < 1e-3);
}

#[test]
fn a_contact_across_phase_0_counts_once() {
    let mut db = small_db();
    let contacts = &mut db.rows.contacts[WALK * PHASE_COUNT..(WALK + 1) * PHASE_COUNT];
    contacts[20][1] = 0.25;
    let feet = feet(&db, WALK);
    assert_eq!(feet.contacts(Side::Right.index()), [(45, 39)]);
    let [landing, leaving] = feet.stance(Side::Right).unwrap();
    // From 1 at row 19 to 0.25 at row 20; from 1 at row −19 to 0 before it.
    assert!((leaving - (19.0 + 0.5 / 0.75) / 64.0).abs() < 1e-12 && (landing + 19.5 / 64.0).abs() < 1e-12);
}

/// Checks that the fault gives new findings of the walk for exactly these measures.
#[track_caller]
fn check_finds(measures: &[&str], fault: impl Fn(&mut MotionDb)) {
    let mut db = small_db();
    let before: Vec<&str> = lint(&db).iter().map(|finding| finding.measure).collect();
    fault(&mut db);
    let found = lint(&db);
    let new = found.iter().filter(|finding| !before.contains(&finding.measure));
    assert!(new.clone().all(|finding| finding.example == db.examples[WALK].name), "{found:?}");
    assert_eq!(new.map(|finding| finding.measure).collect::<Vec<_>>(), measures);
}

fn rotations(db: &mut MotionDb, joint: Joint) -> impl Iterator<Item = (usize, &mut Quat)> {
    let rows = db.rows.rotations[WALK * PHASE_COUNT * JOINT_COUNT..].iter_mut().skip(joint.index());
    rows.step_by(JOINT_COUNT).take(PHASE_COUNT).enumerate()
}

#[test]
fn each_measure_finds_its_fault() {
    check_finds(&[], |_| ());
    check_finds(&["planted_slide_cm_s"], |db| db.examples[WALK].planted_slide_cm_s = 20.0);
    check_finds(&["planted_share"], |db| db.examples[WALK].planted_share = 0.3);
    check_finds(&["penetration_mm"], |db| db.rows.pelvis_m[WALK * PHASE_COUNT + 5].z -= 0.2);
    check_finds(&["range_excess_deg"], |db| {
        rotations(db, Joint::LeftForearm).for_each(|(_, rotation)| *rotation = Quat::from_rotation_x(2.5));
    });
    check_finds(&["seam_angle_ratio", "seam_velocity_ratio"], |db| {
        let drift = |row: usize| Quat::from_rotation_z(0.01 * row as f32);
        rotations(db, Joint::SpineUpper).for_each(|(row, rotation)| *rotation = drift(row));
    });
}

#[test]
fn stiff_standing_legs_have_exact_figures() {
    let figures = quality(&small_db());
    assert!((figures[0].leg_extension_max - 1.0).abs() < 1e-6 && figures[0].knee_flexion_min_deg.abs() < 1e-3);
    assert_eq!((figures[0].seam_angle_ratio, figures[0].planted_share), (0.0, 1.0));
}

/// Checks that the fault of the start gives findings for exactly these measures.
#[track_caller]
fn check_finds_of_action(measures: &[&str], fault: impl Fn(&mut Action)) {
    let mut db = small_db();
    let before: Vec<&str> = action_quality::lint(&db).iter().map(|finding| finding.measure).collect();
    fault(&mut db.actions[1]);
    let found = action_quality::lint(&db);
    let new = found.iter().filter(|finding| finding.example == "start" && !before.contains(&finding.measure));
    assert_eq!(new.map(|finding| finding.measure).collect::<Vec<_>>(), measures, "{found:?}");
}

#[test]
fn each_measure_finds_its_fault_in_an_action() {
    check_finds_of_action(&[], |_| ());
    // The hand-written start stands stiffly on a root that moves: its feet slide unless they are lifted.
    check_finds_of_action(&[], |start| start.frames.iter_mut().for_each(|frame| frame.contacts = [0.0; 2]));
    check_finds_of_action(&["penetration_mm"], |start| start.frames[5].pose.pelvis_m.z -= 0.2);
    check_finds_of_action(&["range_excess_deg"], |start| {
        start.frames[5].pose.rotations[Joint::LeftForearm.index()] = Quat::from_rotation_x(2.5);
    });
}

#[test]
fn planted_slide_of_an_action_is_the_speed_of_its_soles() {
    let mut db = small_db();
    let slide_cm_s = |db: &MotionDb| action_quality::quality(db, &db.actions[1]).planted_slide_cm_s;
    // The stiff body moves with its root: from 0 to 1.2 m/s, evenly.
    let found_cm_s = slide_cm_s(&db);
    assert!((found_cm_s - 60.0).abs() < 1.0, "{found_cm_s}");
    let frames = &mut db.actions[1].frames;
    for frame in frames.iter_mut() {
        frame.pose.pelvis_m.x -= frame.root.position_m.x;
    }
    let found_cm_s = slide_cm_s(&db);
    assert!(found_cm_s < 0.01, "{found_cm_s}");
    db.actions[1].frames.iter_mut().for_each(|frame| frame.contacts = [0.0; 2]);
    assert_eq!(slide_cm_s(&db), 0.0);
}

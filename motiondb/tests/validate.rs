//! Every invariant holds for a valid database, and is named for a database that breaks it.

mod support;

use glam::{Quat, Vec2};
use motiondb::body::{JOINT_COUNT, Root};
use motiondb::motion::{ActionKind, MotionDb, PHASE_COUNT};
use motiondb::quality::planted_feet::{CycleFeet, foot_slide};
use motiondb::validate::{first_broken, validate};
use motiondb::velocity_sets::velocity_hull::Construction;
use support::{db_with_fingers, small_db};

/// Checks that this invariant is the first that the fault breaks.
#[track_caller]
fn check_breaks(invariant: &str, fault: impl Fn(&mut MotionDb)) {
    let mut db = small_db();
    fault(&mut db);
    let first = validate(&db).into_iter().find(|check| check.broken.is_some());
    let first = first.unwrap_or_else(|| panic!("{invariant}: the fault was not found"));
    assert_eq!(first.name, invariant, "{:?}", first.broken);
}

#[test]
fn a_valid_database_holds_every_invariant() {
    for check in validate(&small_db()) {
        assert_eq!(check.broken, None, "{}", check.name);
    }
}

#[test]
fn independent_faults_are_all_named() {
    let mut db = small_db();
    db.examples[1].planted_share = 0.9;
    db.blend_space.covered_share = 0.9;
    let broken = validate(&db).into_iter().filter(|check| check.broken.is_some()).map(|check| check.name);
    assert_eq!(broken.collect::<Vec<_>>(), ["planted_feet_slide_as_stored", "simplices_tile_the_hull"]);
}

#[test]
fn faults_of_structure_are_named() {
    check_breaks("has_examples", |db| db.examples.clear());
    check_breaks("rows_are_complete", |db| db.rows.rotations.truncate(100));
    check_breaks("rows_are_complete", |db| db.rows.contacts.push([1.0; 2]));
    check_breaks("indices_are_in_range", |db| db.examples[1].source = 7);
    check_breaks("indices_are_in_range", |db| db.blend_space.simplices[0] = 9);
    check_breaks("indices_are_in_range", |db| db.blend_space.simplices.push(0));
    check_breaks("indices_are_in_range", |db| db.blend_space.dimension = u32::MAX);
    check_breaks("names_are_unique", |db| db.examples[1].name = db.examples[0].name.clone());
}

#[track_caller]
fn check_extra_breaks(invariant: &str, fault: impl Fn(&mut MotionDb)) {
    check_breaks(invariant, |db| {
        *db = db_with_fingers();
        fault(db);
    });
}

#[test]
fn faults_of_extra_joints_are_named() {
    assert!(validate(&db_with_fingers()).iter().all(|check| check.broken.is_none()));
    let complete = "extra_joints_are_complete";
    check_extra_breaks(complete, |db| db.extra.bones.reverse());
    check_extra_breaks(complete, |db| db.extra.bones.rotate_left(1));
    check_extra_breaks(complete, |db| db.extra.bones.retain(|bone| bone.joint.index() > 6));
    check_extra_breaks(complete, |db| db.extra.rotations.truncate(7));
    check_extra_breaks(complete, |db| db.extra.actions.truncate(1));
    check_extra_breaks(complete, |db| db.extra.actions[1].truncate(3));
    check_extra_breaks(complete, |db| db.extra.bones.clear());
    let values = "extra_rotations_are_unit_and_aligned";
    check_extra_breaks(values, |db| db.extra.bones[1].offset_m.x = f32::NAN);
    check_extra_breaks(values, |db| db.extra.rotations[9] *= 1.1);
    check_extra_breaks(values, |db| db.extra.actions[0][9] *= -1.0);
    check_extra_breaks("styles_share_the_skeleton", |db| {
        db.style = "neutral".into();
        let mut other = MotionDb { style: "elderly".into(), ..db.clone() };
        other.extra.bones[0].offset_m.y += 0.01;
        db.further_styles.push(other);
    });
}

#[test]
fn faults_of_values_are_named() {
    check_breaks("skeleton_is_a_body", |db| db.skeleton.offsets_m[3].x = f32::NAN);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.offsets_m[3].x = 20.0);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.segment_radii_m[0] = 0.0);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.limits_rad[4].swap(0, 1));
    check_breaks("skeleton_is_a_body", |db| db.skeleton.limits_rad[4][1].y = 10.5);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.limits_rad[4][0].z = f32::NEG_INFINITY);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.feet[1].measured_m[2].z = f32::NEG_INFINITY);
    check_breaks("sources_are_finite", |db| db.sources[0].speed_mps = f32::NAN);
    check_breaks("sources_are_finite", |db| db.sources[0].frame_rate_hz = 0.0);
    check_breaks("windows_are_ordered", |db| db.examples[0].window_s = [2.0, 1.0]);
    check_breaks("windows_are_ordered", |db| db.examples[0].window_s = [0.0, f32::INFINITY]);
    check_breaks("parameters_are_human", |db| db.examples[0].parameters.speed_mps = f32::INFINITY);
    check_breaks("parameters_are_human", |db| db.examples[0].parameters.turn_rate_rad_s = 90.0);
    check_breaks("phase_maps_rise", |db| db.examples[1].phase_map.left_share = 0.9);
    check_breaks("phase_maps_rise", |db| db.examples[1].phase_map.period_s = f32::NAN);
    check_breaks("rows_are_finite", |db| db.rows.pelvis_m[70].z = f32::NAN);
    check_breaks("rows_are_finite", |db| db.rows.contacts[3][1] = -0.1);
    check_breaks("rotations_are_unit_and_aligned", |db| db.rows.rotations[100] = Quat::from_xyzw(0.0, 0.0, 0.0, 0.5));
    check_breaks("rotations_are_unit_and_aligned", |db| db.rows.rotations[100] = -db.rows.rotations[100]);
}

#[test]
fn faults_of_the_motion_are_named() {
    check_breaks("cycles_close", |db| {
        let pelvis = db.rows.rotations.iter_mut().step_by(JOINT_COUNT).take(PHASE_COUNT);
        pelvis.enumerate().for_each(|(phase, rotation)| *rotation = Quat::from_rotation_x(0.02 * phase as f32));
    });
    let walk = PHASE_COUNT..2 * PHASE_COUNT;
    check_breaks("landmarks_are_mid_stances", |db| db.rows.contacts[walk.clone()].rotate_left(PHASE_COUNT / 2));
    check_breaks("landmarks_are_mid_stances", |db| db.rows.contacts[walk.clone()].rotate_left(PHASE_COUNT / 7));
    check_breaks("landmarks_are_mid_stances", |db| db.rows.contacts[walk.clone()].fill([1.0; 2]));
    check_breaks("landmarks_are_mid_stances", |db| db.examples[1].key_times_s = None);
    check_breaks("landmarks_are_mid_stances", |db| db.rows.contacts[20][0] = 0.0);
    check_breaks("key_times_end_contacts", |db| db.examples[1].key_times_s = Some([0.1, 0.2, 0.3, 1.5]));
    check_breaks("key_times_end_contacts", |db| {
        db.examples[1].key_times_s.as_mut().expect("it steps").swap(0, 2);
    });
    check_breaks("planted_feet_slide_as_stored", |db| db.examples[1].planted_share = 1.2);
    check_breaks("planted_feet_slide_as_stored", |db| db.examples[1].planted_slide_cm_s += 0.5);
}

#[test]
fn a_speed_that_contradicts_the_feet_is_named() {
    for factor in [0.75, 1.25, -1.0] {
        let mut db = small_db();
        let mut forged = db.examples[1].parameters;
        forged.speed_mps *= factor;
        db.examples[1].parameters = forged;
        let feet = CycleFeet::of(&db, 1, &db.posed_rows(1));
        db.examples[1].planted_slide_cm_s = foot_slide(&feet, forged.to_vec3().as_dvec3()).slide_cm_s as f32;
        let broken = validate(&db).into_iter().find(|check| check.broken.is_some()).expect("the speed is forged");
        assert_eq!(broken.name, "parameters_follow_from_the_motion");
    }
}

#[test]
fn faults_of_derived_sets_are_named() {
    check_breaks("hulls_are_clockwise_and_convex", |db| db.velocity_hull.turning_mps.reverse());
    check_breaks("hulls_are_clockwise_and_convex", |db| db.velocity_hull.holding_mps.clear());
    check_breaks("hulls_are_clockwise_and_convex", |db| {
        let twice = [&db.velocity_hull.turning_mps[..], &db.velocity_hull.turning_mps].concat();
        db.velocity_hull.turning_mps = twice;
    });
    check_breaks("hulls_wrap_their_examples", |db| db.velocity_hull.holding_mps[1].x = 1.0);
    check_breaks("hulls_wrap_their_examples", |db| db.velocity_hull.holding_mps[1].x = 1.4);
    check_breaks("hulls_wrap_their_examples", |db| db.velocity_hull.turning_mps[2].x = 1.4);
    check_breaks("hulls_wrap_their_examples", |db| db.velocity_hull.construction = Construction::Paper);
    check_breaks("sharp_turns_wrap_the_turning_examples", |db| {
        db.velocity_hull.sharp_turn_edges_mps = vec![[Vec2::new(-0.1, 0.5), Vec2::new(-0.5, -0.1)]];
    });
    check_breaks("simplices_tile_the_hull", |db| db.blend_space.covered_share = 0.9);
    check_breaks("simplices_tile_the_hull", |db| db.blend_space.axis_ranges[0] = f32::NAN);
    check_breaks("simplices_tile_the_hull", |db| db.blend_space.simplices = vec![0, 1, 2, 2, 1, 0]);
    let pairs = |db: &mut MotionDb, pairs_s: &[[f32; 2]]| {
        db.correspondence.as_mut().expect("the small database has one").pairs_s = pairs_s.to_vec();
    };
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[]));
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[[0.2, 0.3], [0.4, 0.2], [0.6, 0.5]]));
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[[0.2, 0.3], [9.0, 0.4]]));
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[[0.2, 0.3], [0.4, 0.4]]));
    check_breaks("correspondences_are_cyclic", |db| db.correspondence = None);
}

#[test]
fn faults_of_actions_are_named() {
    check_breaks("actions_are_complete", |db| db.actions[0].frames.truncate(1));
    check_breaks("actions_are_complete", |db| db.actions[1].source = 9);
    check_breaks("actions_are_complete", |db| db.actions[1].exit.example = 9);
    check_breaks("actions_are_complete", |db| db.actions[1].name = db.actions[0].name.clone());
    check_breaks("actions_are_complete", |db| db.actions.swap(0, 1));
    check_breaks("action_frames_are_finite", |db| db.actions[1].window_s = [1.0, 0.5]);
    check_breaks("action_frames_are_finite", |db| db.actions[1].entry.phase = 1.0);
    check_breaks("action_frames_are_finite", |db| db.actions[1].frames[3].pose.pelvis_m.z = f32::NAN);
    check_breaks("action_frames_are_finite", |db| db.actions[1].frames[3].contacts[1] = 1.5);
    check_breaks("action_frames_are_finite", |db| db.actions[1].frames[3].root.facing_rad = f32::INFINITY);
    check_breaks("action_rotations_are_unit_and_aligned", |db| {
        let rotation = &mut db.actions[0].frames[9].pose.rotations[4];
        *rotation = -*rotation;
    });
    check_breaks("idles_are_loops", |db| db.actions[0].frames[9].contacts[0] = 0.2);
    check_breaks("idles_are_loops", |db| {
        db.actions[0].frames[60].pose.rotations[4] = Quat::from_rotation_x(0.01);
    });
    check_breaks("actions_meet_their_examples", |db| db.actions[1].kind = ActionKind::Step);
    check_breaks("actions_meet_their_examples", |db| db.actions[1].exit.example = 2);
    check_breaks("actions_meet_their_examples", |db| db.actions[1].frames[0].root.facing_rad = 0.1);
    check_breaks("actions_meet_their_examples", |db| {
        db.actions[1].frames[72].root.position_m.x += 0.01;
    });
}

/// Makes the start a movement on the spot, which turns by an angle and travels forward.
fn stand_and_move(db: &mut MotionDb, kind: ActionKind, turn_rad: f32, moved_m: f32) {
    let start = &mut db.actions[1];
    (start.kind, start.exit) = (kind, start.entry);
    let last = start.frames.len() - 1;
    for (index, frame) in start.frames.iter_mut().enumerate() {
        let share = index as f32 / last as f32;
        let smooth = share * share * (3.0 - 2.0 * share);
        frame.root = Root { position_m: Vec2::X * moved_m * smooth, facing_rad: turn_rad * smooth };
    }
}

#[test]
fn faults_of_transitions_are_named() {
    for (kind, turn_rad, moved_m) in [(ActionKind::Turn, -1.0, 0.0), (ActionKind::Step, 0.0, 0.3)] {
        let mut db = small_db();
        stand_and_move(&mut db, kind, turn_rad, moved_m);
        assert_eq!(first_broken(&db), None);
        db.actions[1].frames[72].contacts[0] = 0.0;
        assert_eq!(first_broken(&db).map(|(name, _)| name), Some("transitions_move_as_their_kind"));
    }
    check_breaks("transitions_move_as_their_kind", |db| stand_and_move(db, ActionKind::Turn, 0.3, 0.2));
    check_breaks("transitions_move_as_their_kind", |db| stand_and_move(db, ActionKind::Step, 0.3, 0.0));
    check_breaks("transitions_move_as_their_kind", |db| db.actions[1].frames[0].contacts[1] = 0.4);
    check_breaks("transitions_have_no_jumps", |db| db.actions[1].frames[30].pose.pelvis_m.y += 0.2);
    check_breaks("transitions_have_no_jumps", |db| {
        db.actions[1].frames[30].pose.rotations[5] = Quat::from_rotation_x(1.2);
    });
}

//! Every invariant holds for a sound database, and names the fault of one that breaks it.

mod support;

use glam::{Quat, Vec2, Vec3};
use motiondb::motion_db::{MotionDb, PHASE_COUNT};
use motiondb::skeleton::JOINT_COUNT;
use motiondb::validate::validate;
use support::small_db;

/// Fails unless exactly this invariant is the first that a fault breaks.
#[track_caller]
fn check_breaks(invariant: &str, fault: impl Fn(&mut MotionDb)) {
    let mut db = small_db();
    fault(&mut db);
    let first = validate(&db).into_iter().find(|check| check.broken.is_some());
    let first = first.unwrap_or_else(|| panic!("{invariant}: the fault went unseen"));
    assert_eq!(first.name, invariant, "{:?}", first.broken);
}

#[test]
fn a_sound_database_holds_every_invariant() {
    for check in validate(&small_db()) {
        assert_eq!(check.broken, None, "{}", check.name);
    }
}

#[test]
fn faults_that_do_not_depend_on_each_other_are_all_named() {
    let mut db = small_db();
    db.examples[0].planted_share = -1.0;
    db.blend_space.covered_share = 0.9;
    let broken = validate(&db).into_iter().filter(|check| check.broken.is_some()).map(|check| check.name);
    assert_eq!(broken.collect::<Vec<_>>(), ["key_times_lie_in_the_cycle", "simplices_cover_the_examples"]);
}

#[test]
fn faults_of_structure_are_named() {
    check_breaks("has_examples", |db| db.examples.clear());
    check_breaks("skeleton_is_a_body", |db| db.skeleton.offsets_m[3].x = f32::NAN);
    check_breaks("skeleton_is_a_body", |db| db.skeleton.segment_radii_m[0] = 0.0);
    check_breaks("rows_are_complete", |db| db.rows.rotations.truncate(100));
    check_breaks("rows_are_complete", |db| db.rows.contacts.push([1.0; 2]));
    check_breaks("indices_are_in_range", |db| db.examples[1].source = 7);
    check_breaks("indices_are_in_range", |db| db.blend_space.simplices[0] = 9);
    check_breaks("indices_are_in_range", |db| db.blend_space.simplices.push(0));
    check_breaks("indices_are_in_range", |db| db.blend_space.dimension = u32::MAX);
    check_breaks("names_are_unique", |db| db.examples[1].name = db.examples[0].name.clone());
}

#[test]
fn faults_of_examples_are_named() {
    check_breaks("parameters_are_human", |db| db.examples[0].parameters.speed_mps = f32::INFINITY);
    check_breaks("parameters_are_human", |db| db.examples[0].parameters.turn_rate_rad_s = 90.0);
    check_breaks("phase_maps_rise", |db| db.examples[1].phase_map.left_share = 0.9);
    check_breaks("phase_maps_rise", |db| db.examples[1].phase_map.period_s = f32::NAN);
    check_breaks("key_times_lie_in_the_cycle", |db| db.examples[1].key_times_s = Some([0.1, 0.2, 0.3, 1.5]));
    check_breaks("key_times_lie_in_the_cycle", |db| db.examples[1].planted_share = 1.2);
    check_breaks("rows_are_finite", |db| db.rows.pelvis_m[70].z = f32::NAN);
    check_breaks("rows_are_finite", |db| db.rows.contacts[3][1] = -0.1);
    check_breaks("rotations_are_unit_and_aligned", |db| db.rows.rotations[100] = Quat::from_xyzw(0.0, 0.0, 0.0, 0.5));
    check_breaks("rotations_are_unit_and_aligned", |db| db.rows.rotations[100] = -db.rows.rotations[100]);
    check_breaks("cycles_close", |db| {
        let pelvis = db.rows.rotations.iter_mut().step_by(JOINT_COUNT).take(PHASE_COUNT);
        pelvis.enumerate().for_each(|(phase, rotation)| *rotation = Quat::from_rotation_x(0.02 * phase as f32));
    });
}

#[test]
fn faults_of_derived_sets_are_named() {
    check_breaks("hulls_are_clockwise_and_convex", |db| db.velocity_hull.turning_mps.reverse());
    check_breaks("hulls_are_clockwise_and_convex", |db| db.velocity_hull.holding_mps.clear());
    check_breaks("hulls_hold_their_examples", |db| db.examples[1].parameters.speed_mps = 3.0);
    check_breaks("sharp_turn_edges_hold_the_origin", |db| {
        db.velocity_hull.sharp_turn_edges_mps = vec![[Vec2::new(-0.1, 0.5), Vec2::new(-0.5, -0.1)]];
    });
    check_breaks("simplices_cover_the_examples", |db| db.blend_space.covered_share = 0.9);
    check_breaks("simplices_cover_the_examples", |db| db.blend_space.axis_ranges[0] = Vec3::NAN.x);
    let pairs = |db: &mut MotionDb, pairs_s: &[[f32; 2]]| {
        db.correspondence.as_mut().expect("the small database has one").pairs_s = pairs_s.to_vec();
    };
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[]));
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[[0.2, 0.3], [0.4, 0.2], [0.6, 0.5]]));
    check_breaks("correspondences_are_cyclic", |db| pairs(db, &[[0.2, 0.3], [9.0, 0.4]]));
}

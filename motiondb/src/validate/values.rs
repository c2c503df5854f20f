//! Invariants of single values: ranges of numbers, rotations, poses and the body.

use std::f32::consts::PI;
use std::ops::RangeInclusive;

use glam::Vec3;

use crate::body::skeleton::{BONE_MAX_M, JOINT_COUNT, Joint, LIMIT_MAX_RAD};
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::phase_map::MAX_ASYMMETRY;
use crate::validate::{CheckResult, each, ensure};

/// Greatest difference of a rotation's length from 1: rounding.
pub(crate) const UNIT_TOLERANCE: f32 = 1e-3;
/// Greatest speed, m/s: no human is faster; above it a unit is wrong.
const SPEED_LIMIT_MPS: f32 = 15.0;
/// Greatest turn rate, rad/s: two turns a second; above it a unit is wrong.
const TURN_LIMIT_RAD_S: f32 = 4.0 * PI;
/// Range of leg lengths, m: a small child's to a giant's; beyond it a unit is wrong.
const LEG_M: RangeInclusive<f32> = 0.1..=3.0;
/// Greatest length of a bone, and distance of a foot's point from its joint, over leg length.
const BONE_MAX_OVER_LEG: f32 = 4.0;
/// Range of the period of a cycle, s.
const PERIOD_S: RangeInclusive<f32> = 0.05..=60.0;

/// Bones are finite, in proportion and shorter than [`BONE_MAX_M`], legs have length, radii are positive, limits are
/// ordered and within [`LIMIT_MAX_RAD`]. The reader of a recording relies on both maxima.
pub(crate) fn skeleton_is_a_body(db: &MotionDb) -> CheckResult {
    let skeleton = &db.skeleton;
    let leg_m = skeleton.leg_length_m();
    ensure(LEG_M.contains(&leg_m), || format!("the legs are {leg_m} m long"))?;
    let near = |length_m: f32| length_m <= (BONE_MAX_OVER_LEG * leg_m).min(BONE_MAX_M);
    let is_limit = |limit: Vec3| limit.is_finite() && limit.abs().max_element() <= LIMIT_MAX_RAD;
    for joint in Joint::ALL {
        let index = joint.index();
        let [least, greatest] = skeleton.limits_rad[index];
        let bones_m = [skeleton.offsets_m[index], skeleton.segment_ends_m[index]];
        ensure(bones_m.iter().all(|bone| near(bone.length())), || format!("{} has bones {bones_m:?} m", joint.name()))?;
        ensure(is_limit(least) && is_limit(greatest) && least.cmple(greatest).all(), || {
            format!("the limits of {} are {least} to {greatest} rad", joint.name())
        })?;
        let radius_m = skeleton.segment_radii_m[index];
        ensure(radius_m > 0.0 && near(radius_m), || format!("{} has radius {radius_m} m", joint.name()))?;
    }
    for foot in &skeleton.feet {
        let mut points = [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m);
        ensure(points.all(|point| near(point.length())), || {
            format!("a point of a foot is far from its joint: {foot:?}")
        })?;
    }
    Ok(())
}

/// Parameters of the sources are finite; their frame rates and units are positive.
pub(crate) fn sources_are_finite(db: &MotionDb) -> CheckResult {
    for source in &db.sources {
        let finite =
            [source.speed_mps, source.turn_rate_rad_s, source.strafe_mps].iter().all(|value| value.is_finite());
        let positive =
            [source.metres_per_unit, source.frame_rate_hz].iter().all(|&value| value > 0.0 && value.is_finite());
        ensure(finite && positive, || format!("a value is out of range in {source:?}"))?;
    }
    Ok(())
}

/// The source's part that an example was made from ends after its start.
pub(crate) fn windows_are_ordered(db: &MotionDb) -> CheckResult {
    each(db, |_, example| {
        let [first_s, last_s] = example.window_s;
        ensure(first_s >= 0.0 && first_s < last_s && last_s.is_finite(), || {
            format!("it is made from {first_s} s to {last_s} s of its source")
        })
    })
}

/// Parameters are finite and humanly possible.
pub(crate) fn parameters_are_human(db: &MotionDb) -> CheckResult {
    each(db, |_, example| {
        let found = example.parameters;
        let human = found.speed_mps.abs() <= SPEED_LIMIT_MPS
            && found.strafe_mps.abs() <= SPEED_LIMIT_MPS
            && found.turn_rate_rad_s.abs() <= TURN_LIMIT_RAD_S;
        ensure(human, || format!("no human moves at {found:?}"))
    })
}

/// Time rises with phase in every example.
pub(crate) fn phase_maps_rise(db: &MotionDb) -> CheckResult {
    each(db, |_, example| {
        let map = example.phase_map;
        let lasts = PERIOD_S.contains(&map.period_s);
        ensure(lasts && (map.left_share - 0.5).abs() <= MAX_ASYMMETRY, || format!("it has {map:?}"))
    })
}

/// Pelvis positions are finite, above the ground and near the root; contacts are in [0, 1].
pub(crate) fn rows_are_finite(db: &MotionDb) -> CheckResult {
    let leg_m = db.skeleton.leg_length_m();
    for (row, (pelvis_m, contacts)) in db.rows.pelvis_m.iter().zip(&db.rows.contacts).enumerate() {
        let position = || format!("{}, phase {}", db.examples[row / PHASE_COUNT].name, row % PHASE_COUNT);
        ensure(is_near_root(*pelvis_m, leg_m), || format!("{}: the pelvis is at {pelvis_m} m", position()))?;
        ensure(contacts.iter().all(|contact| (0.0..=1.0).contains(contact)), || {
            format!("{}: the contacts are {contacts:?}", position())
        })?;
    }
    Ok(())
}

/// Whether a pelvis is near its root, above the ground.
pub(crate) fn is_near_root(pelvis_m: Vec3, leg_m: f32) -> bool {
    pelvis_m.truncate().length() < 2.0 * leg_m && pelvis_m.z > 0.0 && pelvis_m.z < 3.0 * leg_m
}

/// Rotations are unit quaternions. In every row, each joint is in the hemisphere of the first row.
pub(crate) fn rotations_are_unit_and_aligned(db: &MotionDb) -> CheckResult {
    let first = db.rows.rotations(0, 0);
    for (entry, rotation) in db.rows.rotations.iter().enumerate() {
        let (row, joint) = (entry / JOINT_COUNT, entry % JOINT_COUNT);
        let position = || {
            let example = &db.examples[row / PHASE_COUNT].name;
            format!("{example}, phase {}, {}", row % PHASE_COUNT, Joint::ALL[joint].name())
        };
        ensure((rotation.length() - 1.0).abs() < UNIT_TOLERANCE, || {
            format!("{}: the rotation {rotation} has no unit length", position())
        })?;
        ensure(rotation.dot(first[joint]) >= -UNIT_TOLERANCE, || {
            format!("{}: the rotation is in the other hemisphere", position())
        })?;
    }
    Ok(())
}

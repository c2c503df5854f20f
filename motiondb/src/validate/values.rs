//! What a number, a rotation, a pose or a body may be, each by itself.

use std::f32::consts::PI;
use std::ops::RangeInclusive;

use crate::body::skeleton::{JOINT_COUNT, Joint};
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::phase_map::MAX_ASYMMETRY;
use crate::validate::{Outcome, each, ensure};

/// A rotation's length may be off 1 by rounding.
const UNIT_TOLERANCE: f32 = 1e-3;
/// No human motion is faster; beyond lies a unit error.
const SPEED_LIMIT_MPS: f32 = 15.0;
/// Nor turns faster: two turns a second.
const TURN_LIMIT_RAD_S: f32 = 4.0 * PI;
/// From a child's, in metres, to a giant's; beyond lies a unit error.
const LEG_M: RangeInclusive<f32> = 0.1..=3.0;
/// No bone and no point of a foot is further from its joint than this, over leg length.
const BONE_MAX_OVER_LEG: f32 = 4.0;
/// A cycle takes this long, seconds.
const PERIOD_S: RangeInclusive<f32> = 0.05..=60.0;

/// Bones are finite and in proportion, legs have length, radii are positive, limits are ordered.
pub(crate) fn skeleton_is_a_body(db: &MotionDb) -> Outcome {
    let skeleton = &db.skeleton;
    let leg_m = skeleton.leg_length_m();
    ensure(LEG_M.contains(&leg_m), || format!("legs are {leg_m} m long"))?;
    let near = |length_m: f32| length_m <= BONE_MAX_OVER_LEG * leg_m;
    for joint in Joint::ALL {
        let index = joint.index();
        let [least, greatest] = skeleton.limits_rad[index];
        let bones_m = [skeleton.offsets_m[index], skeleton.segment_ends_m[index]];
        ensure(bones_m.iter().all(|bone| near(bone.length())), || format!("{} has bones {bones_m:?} m", joint.name()))?;
        ensure(least.is_finite() && greatest.is_finite() && least.cmple(greatest).all(), || {
            format!("the limits of {} are {least} to {greatest} rad", joint.name())
        })?;
        let radius_m = skeleton.segment_radii_m[index];
        ensure(radius_m > 0.0 && near(radius_m), || format!("{} has radius {radius_m} m", joint.name()))?;
    }
    for foot in &skeleton.feet {
        let mut points = [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m);
        ensure(points.all(|point| near(point.length())), || format!("a point of a foot is far from it: {foot:?}"))?;
    }
    Ok(())
}

/// What was found in the sources is finite, their frames have a rate and their units a length.
pub(crate) fn sources_are_finite(db: &MotionDb) -> Outcome {
    for source in &db.sources {
        let finite =
            [source.speed_mps, source.turn_rate_rad_s, source.strafe_mps].iter().all(|value| value.is_finite());
        let positive =
            [source.metres_per_unit, source.frame_rate_hz].iter().all(|&value| value > 0.0 && value.is_finite());
        ensure(finite && positive, || format!("{source:?}"))?;
    }
    Ok(())
}

/// The part of the source that an example was made from ends after it begins.
pub(crate) fn windows_are_ordered(db: &MotionDb) -> Outcome {
    each(db, |_, example| {
        let [first_s, last_s] = example.window_s;
        ensure(first_s >= 0.0 && first_s < last_s && last_s.is_finite(), || format!("{first_s} s to {last_s} s"))
    })
}

/// Parameters are finite and within human reach.
pub(crate) fn parameters_are_human(db: &MotionDb) -> Outcome {
    each(db, |_, example| {
        let found = example.parameters;
        let human = found.speed_mps.abs() <= SPEED_LIMIT_MPS
            && found.strafe_mps.abs() <= SPEED_LIMIT_MPS
            && found.turn_rate_rad_s.abs() <= TURN_LIMIT_RAD_S;
        ensure(human, || format!("{found:?}"))
    })
}

/// Time rises with phase in every example.
pub(crate) fn phase_maps_rise(db: &MotionDb) -> Outcome {
    each(db, |_, example| {
        let map = example.phase_map;
        let lasts = PERIOD_S.contains(&map.period_s);
        ensure(lasts && (map.left_share - 0.5).abs() <= MAX_ASYMMETRY, || format!("{map:?}"))
    })
}

/// Rows are finite, pelvises over the ground and contacts within [0, 1].
pub(crate) fn rows_are_finite(db: &MotionDb) -> Outcome {
    let leg_m = db.skeleton.leg_length_m();
    for (row, (pelvis_m, contacts)) in db.rows.pelvis_m.iter().zip(&db.rows.contacts).enumerate() {
        let place = || format!("{}, phase {}", db.examples[row / PHASE_COUNT].name, row % PHASE_COUNT);
        let near = pelvis_m.truncate().length() < 2.0 * leg_m && pelvis_m.z > 0.0 && pelvis_m.z < 3.0 * leg_m;
        ensure(near, || format!("{}: pelvis at {pelvis_m}", place()))?;
        ensure(contacts.iter().all(|contact| (0.0..=1.0).contains(contact)), || format!("{}: {contacts:?}", place()))?;
    }
    Ok(())
}

/// Rotations are unit quaternions, and every row lies in the first row's hemisphere, joint by joint.
pub(crate) fn rotations_are_unit_and_aligned(db: &MotionDb) -> Outcome {
    let first = db.rows.rotations(0, 0);
    for (entry, rotation) in db.rows.rotations.iter().enumerate() {
        let (row, joint) = (entry / JOINT_COUNT, entry % JOINT_COUNT);
        let place = || {
            let example = &db.examples[row / PHASE_COUNT].name;
            format!("{example}, phase {}, {}", row % PHASE_COUNT, Joint::ALL[joint].name())
        };
        ensure((rotation.length() - 1.0).abs() < UNIT_TOLERANCE, || format!("{}: {rotation}", place()))?;
        ensure(rotation.dot(first[joint]) >= -UNIT_TOLERANCE, || format!("{}: in the other hemisphere", place()))?;
    }
    Ok(())
}

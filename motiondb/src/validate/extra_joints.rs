//! Invariants of the joints beside the 22 roles ([`crate::motion::ExtraMotion`]).

use glam::Quat;

use crate::body::extra_joint::{EXTRA_JOINTS_MAX, ExtraParent};
use crate::body::skeleton::BONE_MAX_M;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::validate::values::UNIT_TOLERANCE;
use crate::validate::{CheckResult, ensure};

/// Extra joints are sorted and unique, at most [`EXTRA_JOINTS_MAX`], each with its parent; every row and every frame of
/// an action has all of them.
pub(crate) fn extra_joints_are_complete(db: &MotionDb) -> CheckResult {
    let extra = &db.extra;
    let count = extra.bones.len();
    ensure(count <= EXTRA_JOINTS_MAX, || format!("there are {count} extra joints, more than {EXTRA_JOINTS_MAX}"))?;
    if let Some(pair) = extra.bones.windows(2).find(|pair| pair[0].joint >= pair[1].joint) {
        let [first, second] = [pair[0].joint.name(), pair[1].joint.name()];
        return Err(format!("extra joints are not sorted or not unique: `{first}` is followed by `{second}`"));
    }
    for bone in &extra.bones {
        if let ExtraParent::Extra(parent) = bone.joint.parent() {
            ensure(extra.position(parent).is_some(), || {
                format!("{} has no parent {}", bone.joint.name(), parent.name())
            })?;
        }
    }
    let rotations = count * db.examples.len() * PHASE_COUNT;
    ensure(extra.rotations.len() == rotations, || {
        format!("extra joints have {} rotations; the examples need {rotations}", extra.rotations.len())
    })?;
    let actions = if count == 0 { 0 } else { db.actions.len() };
    ensure(extra.actions.len() == actions, || {
        format!("extra joints have {} actions; the set needs {actions}", extra.actions.len())
    })?;
    for (action, found) in db.actions.iter().zip(&extra.actions) {
        let rotations = count * action.frames.len();
        ensure(found.len() == rotations, || {
            format!("{}: extra joints have {} rotations; the frames need {rotations}", action.name, found.len())
        })?;
    }
    Ok(())
}

/// Bones of extra joints are shorter than [`BONE_MAX_M`]. Rotations are unit quaternions, each joint in the hemisphere
/// of the first row.
pub(crate) fn extra_rotations_are_unit_and_aligned(db: &MotionDb) -> CheckResult {
    let extra = &db.extra;
    if extra.is_empty() {
        return Ok(());
    }
    for bone in &extra.bones {
        ensure(bone.offset_m.length() <= BONE_MAX_M, || {
            format!("{} is {} m from its parent", bone.joint.name(), bone.offset_m)
        })?;
    }
    let first = extra.row(0, 0);
    let check = |entry: usize, rotation: &Quat, position: &dyn Fn(usize) -> String| {
        let (row, joint) = (entry / first.len(), entry % first.len());
        let is_unit = (rotation.length() - 1.0).abs() < UNIT_TOLERANCE;
        ensure(is_unit && rotation.dot(first[joint]) >= -UNIT_TOLERANCE, || {
            let joint = extra.bones[joint].joint.name();
            format!("{}, {joint}: {rotation} has no unit length, or is in the other hemisphere", position(row))
        })
    };
    let of_row = |row: usize| format!("{}, phase {}", db.examples[row / PHASE_COUNT].name, row % PHASE_COUNT);
    extra.rotations.iter().enumerate().try_for_each(|(entry, rotation)| check(entry, rotation, &of_row))?;
    db.actions.iter().zip(&extra.actions).try_for_each(|(action, rotations)| {
        let of_frame = |frame: usize| format!("{}, frame {frame}", action.name);
        rotations.iter().enumerate().try_for_each(|(entry, rotation)| check(entry, rotation, &of_frame))
    })
}

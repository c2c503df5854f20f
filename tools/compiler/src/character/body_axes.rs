//! The body's axes in bind space: up from the ankles to the hips, left from the right to the left hip.
//!
//! An axis of the file that is near counts as exact, so that a stance with one foot ahead does not tilt the body.

use glam::{DMat3, DMat4, DQuat, DVec3};
use motiondb::body::Joint;

use crate::character::bind_pose::BindPose;
use crate::character::joint_roles::SlotMap;
use crate::character::reason::CharacterReason;

/// Cosine of the greatest angle between a direction of the body and an axis that counts as that direction, 20°.
const NEAR_COSINE: f64 = 0.94;

/// Bind space → body axes (x forward, y left, z up), without translation.
pub(crate) fn to_body(pose: &BindPose, slots: &SlotMap) -> Result<DMat4, CharacterReason> {
    let position_m = |joint: Joint| slots[joint.index()].map_or(DVec3::ZERO, |slot| pose.position_m(slot));
    let [hips_m, ankles_m] = [Joint::THIGHS, Joint::FEET].map(|pair| 0.5 * (position_m(pair[0]) + position_m(pair[1])));
    let up = snapped((hips_m - ankles_m).normalize_or_zero());
    let across_m = position_m(Joint::LeftThigh) - position_m(Joint::RightThigh);
    let left = snapped((across_m - up * across_m.dot(up)).normalize_or_zero());
    let forward = left.cross(up).normalize_or_zero();
    let left = up.cross(forward);
    if forward == DVec3::ZERO || !forward.is_finite() {
        return Err(CharacterReason::HipsAtSoles);
    }
    let rotation = DQuat::from_mat3(&DMat3::from_cols(forward, left, up)).normalize().conjugate();
    Ok(DMat4::from_quat(rotation))
}

/// The nearest axis of the file, if it is near; else the direction itself.
fn snapped(direction: DVec3) -> DVec3 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    axes.into_iter().find(|axis| axis.dot(direction) > NEAR_COSINE).unwrap_or(direction)
}

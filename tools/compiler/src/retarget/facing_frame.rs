//! The body's frame on the ground: x along its facing, y to its left. Clips are in metres, z up.

use glam::DVec2;
use motiondb::body::Joint;

use crate::read::source_clip::SourceClip;
use crate::rig::roles::Roles;

/// Facing of the body: the mean of the left → right unit vectors of hips and shoulders, turned by 90° and projected on
/// the ground, rad.
pub(crate) fn facing_rad(clip: &SourceClip, roles: &Roles, frame: usize) -> f64 {
    let across = |[left, right]: [Joint; 2]| {
        let [left, right] = [left, right].map(|joint| clip.position(frame, roles.required(joint)));
        (right - left).normalize_or_zero()
    };
    let right = across(Joint::THIGHS) + across(Joint::UPPER_ARMS);
    libm::atan2(right.x, -right.y)
}

/// Unit vector at an angle from x.
pub(crate) fn heading(angle_rad: f64) -> DVec2 {
    DVec2::new(libm::cos(angle_rad), libm::sin(angle_rad))
}

/// A vector of the ground in the frame of a body that faces along `forward`.
pub(crate) fn in_body_frame(vector: DVec2, forward: DVec2) -> DVec2 {
    DVec2::new(vector.dot(forward), forward.perp_dot(vector))
}

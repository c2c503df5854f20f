//! The facing that a manifest states: left and right are exchanged where role search found them the other way round.

use motiondb::body::Joint;
use motiondb::diagnostic::Warning;

use crate::error::{ManifestKey, RejectionReason};
use crate::read::axis::Axis;
use crate::read::source_clip::SourceClip;
use crate::retarget::units::found_up;
use crate::rig::roles::Roles;

/// Greatest deviation of the facing from the stated axis, as a cosine (60°).
const FACING_COSINE: f64 = 0.5;

/// Greatest cosine between a foot and the stated axis of a body that walks backward (120°).
const BACKWARD_COSINE: f64 = -0.5;

/// Exchanges the sides of `roles` where the hips of the first frame face away from `forward`, an axis of the source. The
/// warning that both feet point the other way.
///
/// # Errors
/// If that axis is vertical, or more than 60° off the body's facing both ways.
pub(crate) fn apply(clip: &SourceClip, roles: &mut Roles, forward: Axis) -> Result<Option<Warning>, RejectionReason> {
    let contradicted = |problem: String, remedy: &'static str| {
        Err(RejectionReason::ManifestContradicted { key: ManifestKey::Forward, problem, remedy })
    };
    let up = clip.up_axis.unwrap_or_else(|| found_up(clip, roles));
    if up.is_along(forward) {
        let problem = format!("no body faces {} where {} is up", forward.name(), up.name());
        return contradicted(problem, "correct `forward` or `up`");
    }
    let [left, right] = Joint::THIGHS.map(|hip| clip.position(0, roles.required(hip)));
    let facing = (left - right).cross(up.direction()).normalize_or_zero();
    let along = facing.dot(forward.direction());
    if along.abs() < FACING_COSINE {
        let [found, opposite] = [facing, -facing].map(|direction| Axis::nearest(direction).name());
        let problem = format!("the body faces {found} or {opposite}, not {}", forward.name());
        return contradicted(problem, "correct `forward`");
    }
    if along < 0.0 {
        roles.exchange_sides();
    }
    let points_backward = |side: usize| {
        let [ankle, toe] = [Joint::FEET[side], Joint::TOES[side]].map(|joint| roles.joints[joint.index()]);
        let foot = toe.zip(ankle).map(|(toe, ankle)| clip.position(0, toe) - clip.position(0, ankle));
        foot.is_some_and(|foot| foot.normalize_or_zero().dot(forward.direction()) < BACKWARD_COSINE)
    };
    let is_backward = [0, 1].into_iter().all(points_backward);
    Ok(is_backward.then(|| Warning::ForwardAgainstFeet { forward: forward.name() }))
}

//! Which way a body faces where a manifest says it: left and right are exchanged where they were found the wrong way
//! round.

use motiondb::body::Joint;

use crate::error::{Refusal, Setting};
use crate::read::source_clip::SourceClip;
use crate::retarget::axis::Axis;
use crate::retarget::units::found_up;
use crate::rig::roles::Roles;

/// Hips that lie nearer along the axis than across it are none that face it (cosine of 60°).
const SIDEWAYS_COSINE: f64 = 0.5;

/// Makes the hips of the first frame face within 60° of an axis of the source; `roles` as found.
///
/// # Errors
/// Where that axis points up or down, or to the side of the body.
pub(crate) fn face(clip: &SourceClip, roles: &mut Roles, forward: Axis) -> Result<(), Refusal> {
    let up = clip.up_axis.unwrap_or_else(|| found_up(clip, roles));
    if up.is_along(forward) {
        let reason = format!("nobody faces {} where {} is up", forward.name(), up.name());
        return Err(Refusal::Setting { setting: Setting::Forward, reason, remedy: "correct `forward` or `up`" });
    }
    let [left, right] = Joint::THIGHS.map(|hip| clip.position(0, roles.required(hip)));
    let across = (left - right).cross(up.direction()).normalize_or_zero();
    let along = across.dot(forward.direction());
    if along.abs() < SIDEWAYS_COSINE {
        let seen = Axis::nearest(across);
        let other = Axis::nearest(-across);
        let reason = format!("the body faces {} or {}, not {}", seen.name(), other.name(), forward.name());
        return Err(Refusal::Setting { setting: Setting::Forward, reason, remedy: "correct `forward`" });
    }
    if along < 0.0 {
        roles.exchange_sides();
    }
    Ok(())
}

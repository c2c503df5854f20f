//! Which way a body faces where a manifest says it: left and right are exchanged where they were found the wrong way
//! round.

use motiondb::skeleton::Joint;

use crate::axis::Axis;
use crate::error::{Refusal, Setting};
use crate::skeleton_map::Roles;
use crate::source_clip::SourceClip;
use crate::units::found_up;

/// Makes the hips of the first frame face within 90° of an axis of the source; `roles` as found.
///
/// # Errors
/// Where that axis points up or down.
pub(crate) fn face(clip: &SourceClip, roles: &mut Roles, forward: Axis) -> Result<(), Refusal> {
    let up = clip.up_axis.unwrap_or_else(|| found_up(clip, roles));
    if up.is_along(forward) {
        let reason = format!("nobody faces {} where {} is up", forward.name(), up.name());
        return Err(Refusal::Setting { setting: Setting::Forward, reason, remedy: "correct `forward` or `up`" });
    }
    let [left, right] = Joint::THIGHS.map(|hip| clip.position(0, roles.required(hip)));
    if (left - right).cross(up.direction()).dot(forward.direction()) < 0.0 {
        roles.exchange_sides();
    }
    Ok(())
}

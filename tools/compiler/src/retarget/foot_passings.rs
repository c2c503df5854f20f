//! Steps of a source clip: the frames in which one foot passes the other. Clips have z up; the unit is free.

use motiondb::body::Joint;

use crate::read::source_clip::SourceClip;
use crate::retarget::facing_frame::facing_rad;
use crate::rig::roles::Roles;

/// Least distance along the facing by which one foot leads the other in a step, m for a person's leg.
pub(crate) const LEAD_MIN_M: f64 = 0.06;

/// The frames, one for each step, in which one foot passes the other along the facing and then leads it by at least
/// `lead`, in the clip's unit.
pub(crate) fn foot_passings(clip: &SourceClip, roles: &Roles, lead: f64) -> Vec<usize> {
    let mut passings = Vec::new();
    let (mut leading, mut crossed) = (0.0, 0);
    for frame in 0..clip.frame_count() {
        let [left, right] = Joint::FEET.map(|foot| clip.position(frame, roles.required(foot)));
        let facing = facing_rad(clip, roles, frame);
        let left_lead = (left - right).x * libm::cos(facing) + (left - right).y * libm::sin(facing);
        if left_lead * leading <= 0.0 && crossed == 0 {
            crossed = frame;
        } else if left_lead * leading > 0.0 {
            crossed = 0;
        }
        if left_lead.abs() > lead && left_lead * leading <= 0.0 {
            passings.extend((leading != 0.0).then_some(crossed));
            (leading, crossed) = (left_lead, 0);
        }
    }
    passings
}

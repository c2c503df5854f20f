//! Whether a body moves along the line from its feet to its shoulders, as one that climbs, swims, crawls or jumps high.
//! Clips in any axes and unit.

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::Unfit;

use crate::read::axis::Axis;
use crate::read::source_clip::SourceClip;
use crate::retarget::units::{found_up, leg_length, middle};
use crate::rig::roles::Roles;

/// Greatest share of a body's path along the line from feet to shoulders (cosine of 37°). On stairs 0.6, bent double
/// 0.65.
const LENGTHWISE_MAX: f64 = 0.8;
/// Least standard deviation of the hips' position, divided by the leg length, of a body that travels: a straight path
/// of two legs' length. Jumps, and bodies that kneel and rise, reach 0.5.
const TRAVEL_MIN: f64 = 0.6;
/// The same of a body that crawls: a path of one leg's length.
const CRAWL_TRAVEL_MIN: f64 = 0.3;

/// The verdict that the body's path lies along its own length.
pub(crate) fn lengthwise_path(clip: &SourceClip, roles: &Roles) -> Option<Unfit> {
    let [travel, along] = travel(clip, roles);
    (travel > TRAVEL_MIN && along > LENGTHWISE_MAX).then_some(Unfit::MovesLengthwise)
}

/// Whether the body crawls: it moves along its length, and its rest pose stands along another axis.
pub(crate) fn crawls(clip: &SourceClip, roles: &Roles, rest_up: Axis) -> bool {
    let [travel, along] = travel(clip, roles);
    travel > CRAWL_TRAVEL_MIN && along > LENGTHWISE_MAX && found_up(clip, roles) != rest_up
}

/// `[standard deviation of the hips' position in leg lengths, its share along the line from feet to shoulders]`.
fn travel(clip: &SourceClip, roles: &Roles) -> [f64; 2] {
    let count = clip.frame_count() as f64;
    let mean = |value: &dyn Fn(usize) -> DVec3| (0..clip.frame_count()).map(value).sum::<DVec3>() / count;
    let hips = |frame: usize| middle(clip, roles, Joint::THIGHS, frame);
    let centre = mean(&hips);
    let feet_to_shoulders =
        |frame: usize| middle(clip, roles, Joint::UPPER_ARMS, frame) - middle(clip, roles, Joint::FEET, frame);
    let length = mean(&feet_to_shoulders).normalize_or_zero();
    let squares = (0..clip.frame_count()).map(|frame| {
        let offset = hips(frame) - centre;
        (offset.length_squared(), offset.dot(length) * offset.dot(length))
    });
    let (travel, along) = squares.fold((0.0, 0.0), |(travel, along), (all, own)| (travel + all, along + own));
    [(travel / count).sqrt() / leg_length(clip, roles), (along / travel).sqrt()]
}

//! Parts of a clip in which the body stands with its arms spread, as in a bind pose: a T-pose or an A-pose between two parts
//! of an idle, for instance. They give no example. Clips are in metres, z up.

use std::ops::Range;

use motiondb::body::Joint;

use crate::frame_runs::frame_runs;
use crate::read::source_clip::SourceClip;
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::trim_t_poses::{SPREAD_COSINE, arm_spread};
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::body_angles::arms_out_deg;
use crate::rig::roles::Roles;

/// Least angle of both straight arms off straight down in a bind pose, degrees.
pub(crate) const ARMS_OUT_DEG: f64 = 30.0;
/// Angle from straight down above which both arms count as raised, not spread, degrees.
pub(crate) const ARMS_UP_DEG: f64 = 120.0;
/// Greatest speed of the hips of a body that stands, m/s for a person's leg. Styles spread their arms while they walk.
const STANDING_MPS: f64 = 0.15;
/// Half of the span over which that speed is measured, s.
const HALF_SPAN_S: f64 = 0.25;
/// Duration before and after a bind pose in which the arms rise and fall, s.
const MARGIN_S: f64 = 0.4;
/// Greatest share of such parts in a clip; above it the whole clip is a bind pose, and no part is left out.
const SHARE_MAX: f64 = 0.8;

/// The parts of a clip in which the body stands with its arms spread, in order of time. A clip in place, whose hips rest
/// while it walks, has none.
pub(crate) fn spread_parts(clip: &SourceClip, roles: &Roles, parameters: &SourceParameters) -> Vec<Range<usize>> {
    if parameters.is_in_place {
        return Vec::new();
    }
    let count = clip.frame_count();
    let frames_of = |duration_s: f64| ((duration_s * clip.frame_rate_hz) as usize).max(1);
    let (half, margin) = (frames_of(HALF_SPAN_S), frames_of(MARGIN_S));
    let hips = |frame: usize| middle(clip, roles, Joint::THIGHS, frame).truncate();
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let stands = |frame: usize| {
        let (before, after) = (frame.saturating_sub(half), (frame + half).min(count - 1));
        let path_max_m = STANDING_MPS * scale.sqrt() * (after - before) as f64 / clip.frame_rate_hz;
        hips(before).distance(hips(after)) <= path_max_m
    };
    let is_spread = |frame: usize| {
        let position = |joint: Joint| clip.position(frame, roles.required(joint));
        (ARMS_OUT_DEG..ARMS_UP_DEG).contains(&arms_out_deg(position)) || arm_spread(position) > SPREAD_COSINE
    };
    let mut flags = vec![false; count];
    for frame in (0..count).filter(|&frame| is_spread(frame) && stands(frame)) {
        flags[frame.saturating_sub(margin)..(frame + margin + 1).min(count)].fill(true);
    }
    let share = flags.iter().filter(|flag| **flag).count() as f64 / count as f64;
    if share > SHARE_MAX { Vec::new() } else { frame_runs(&flags, true) }
}

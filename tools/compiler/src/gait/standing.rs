//! Where in a clip the body stands: both feet planted, hips, ankles and joints at rest.
//!
//! Times in frames of the clip; world frame, metres, seconds.

use std::ops::Range;

use crate::frame_runs::frame_runs;
use crate::gait::body_track::BodyTrack;

/// Speed of hips and ankles below which a body stands, m/s.
const STANDING_SPEED_MPS: f64 = 0.06;
/// Mean speed of the joints below which a body stands, m/s: breathing and weight shifts have 0.003–0.02, dances more.
pub(crate) const STANDING_JOINT_SPEED_MPS: f64 = 0.06;
/// Greatest horizontal travel of an ankle in a rest, m. Captured idles: up to 0.04; on a turntable it is passed at 50°.
const ANKLES_TRAVEL_MAX_M: f64 = 0.1;
/// Share of its frames for which each foot of a clip that stands as a whole is planted.
const STANDING_SHARE_MIN: f64 = 0.95;
/// Least duration of a clip that stands, and of a brief rest in a capture, s; what is shorter is a pose.
pub(crate) const STANDING_MIN_S: f64 = 0.5;
/// Span over which speeds within a capture are taken, s: a pause between two steps is not standing.
const REST_SPAN_S: f64 = 0.5;
/// Least duration of a rest in a capture, s: longer than a stride of m_sp, so that the steps before and after fade.
pub(crate) const REST_MIN_S: f64 = 1.5;

/// Whether the whole clip stands. `planted` holds the flags of both feet.
pub(crate) fn stands(planted: &[Vec<bool>; 2], track: &BodyTrack) -> bool {
    let share = |side: &Vec<bool>| side.iter().filter(|planted| **planted).count() as f64 / side.len() as f64;
    track.frame_count() as f64 >= STANDING_MIN_S * track.frame_rate_hz
        && track.net_speed_mps() < STANDING_SPEED_MPS
        && track.mean_joint_speed_mps() < STANDING_JOINT_SPEED_MPS
        && planted.iter().all(|side| share(side) >= STANDING_SHARE_MIN)
        && track.ankles_travel_m(0..track.frame_count()) < ANKLES_TRAVEL_MAX_M
}

/// The rests of more than `least_s` seconds within some frames of a clip that also moves, in order of time.
pub(crate) fn rests(
    planted: &[Vec<bool>; 2],
    track: &BodyTrack,
    frames: Range<usize>,
    least_s: f64,
) -> Vec<Range<usize>> {
    let still = still_frames(track);
    let rests: Vec<bool> = frames.clone().map(|frame| planted[0][frame] && planted[1][frame] && still[frame]).collect();
    let length_min = least_s * track.frame_rate_hz;
    frame_runs(&rests, true)
        .into_iter()
        .filter(|rest| rest.len() as f64 > length_min)
        .map(|rest| frames.start + rest.start..frames.start + rest.end)
        .filter(|rest| track.ankles_travel_m(rest.clone()) < ANKLES_TRAVEL_MAX_M)
        .collect()
}

/// The longest of some rests; of several as long the first.
pub(crate) fn longest(rests: &[Range<usize>]) -> Option<&Range<usize>> {
    // The first of the longest: `max_by_key` alone would take the last.
    rests.iter().rev().max_by_key(|rest| rest.len())
}

/// Whether hips, ankles and joints are at rest about each frame.
fn still_frames(track: &BodyTrack) -> Vec<bool> {
    let path_m = &track.joint_path_m;
    let half = ((0.5 * REST_SPAN_S * track.frame_rate_hz) as usize).max(1);
    let is_still = |frame: usize| {
        let (before, after) = (frame.saturating_sub(half), (frame + half).min(path_m.len() - 1));
        let span_s = (after - before) as f64 / track.frame_rate_hz;
        path_m[after] - path_m[before] < STANDING_JOINT_SPEED_MPS * span_s
            && [0, 1].iter().all(|&side| {
                track.ankles_m[after][side].distance(track.ankles_m[before][side]) < STANDING_SPEED_MPS * span_s
            })
            && track.hips_m[after].distance(track.hips_m[before]) < STANDING_SPEED_MPS * span_s
    };
    (0..path_m.len()).map(is_still).collect()
}

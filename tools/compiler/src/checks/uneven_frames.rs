//! Frames that a capture or its export dropped, or repeated. After a dropped one the body moves as far in one frame as else
//! in two or more; the others are played as if none were missing, so that the motion is too fast. Where each frame is
//! repeated it may be too slow. Clips are in metres, z up.

use motiondb::diagnostic::Warning;
use motiondb::statistics::mean;

use crate::read::source_clip::SourceClip;
use crate::rig::roles::Roles;

/// Least movement in a frame after a dropped one over that in the frames beside it.
const DROPPED_OVER_BESIDE: f64 = 1.6;
/// Greatest movement in such a frame over that in the frames beside it: where it is greater, the pose jumps.
const DROPPED_OVER_BESIDE_MAX: f64 = 4.5;
/// Greatest movement in a repeated frame over that in the frames beside it.
const REPEATED_OVER_BESIDE: f64 = 0.4;
/// Least movement beside a frame that is judged, over the mean of the clip.
const MOVING_SHARE: f64 = 0.5;
/// Least mean speed of the joints of a clip that is judged, m/s: the joints of a body that stands move by chance.
const MOVING_MPS: f64 = 0.2;
/// Least share of missing frames that is reported. No clip of fifteen sources is.
const SHARE_MIN: f64 = 0.03;
/// Least number of dropped frames that is reported.
const DROPPED_MIN: usize = 4;
/// Share of repeated frames from which on they are reported. A film at 24 frames a second that is exported at 30 has a
/// fifth.
const REPEATED_SHARE_MIN: f64 = 0.4;
/// Greatest mean displacement of the joints in a repeated frame, m: rounding.
const REPEATED_M: f64 = 1e-6;

/// The warning that frames are missing, or repeated.
pub(crate) fn warning(clip: &SourceClip, roles: &Roles) -> Option<Warning> {
    let moved_m = moved_m(clip, roles);
    let mean_m = mean(moved_m.iter().copied())?;
    if mean_m * clip.frame_rate_hz < MOVING_MPS {
        return None;
    }
    // A pose that is held for longer is counted once.
    let repeats = moved_m.windows(2).filter(|pair| pair[0] >= REPEATED_M && pair[1] < REPEATED_M).count();
    let repeated = repeats as f64 / moved_m.len() as f64;
    if repeated > REPEATED_SHARE_MIN {
        return Some(Warning::FramesRepeated { share: repeated as f32 });
    }
    dropped(&moved_m, mean_m)
}

/// The warning that frames are missing. Frames that are repeated keep the time, so a clip that has as many is none.
fn dropped(moved_m: &[f64], mean_m: f64) -> Option<Warning> {
    let over_beside = |moved_m: &[f64]| {
        let most_m = moved_m[0].max(moved_m[2]);
        (most_m > MOVING_SHARE * mean_m).then(|| moved_m[1] / most_m)
    };
    let judged: Vec<f64> = moved_m.windows(3).filter_map(over_beside).collect();
    let is_dropped = |over: &&f64| (DROPPED_OVER_BESIDE..DROPPED_OVER_BESIDE_MAX).contains(*over);
    let dropped: Vec<f64> = judged.iter().filter(is_dropped).copied().collect();
    let repeated = judged.iter().filter(|over| **over < REPEATED_OVER_BESIDE).count();
    let missing: f64 = dropped.iter().map(|over| libm::round(over - 1.0)).sum();
    let share = missing / (judged.len() as f64 + missing);
    let is_reported = dropped.len() >= DROPPED_MIN && dropped.len() > 2 * repeated && share > SHARE_MIN;
    is_reported.then_some(Warning::FramesDropped { share: share as f32 })
}

/// Mean displacement of the joints from each frame to the next, m.
fn moved_m(clip: &SourceClip, roles: &Roles) -> Vec<f64> {
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let moved = |frame: usize| {
        let of_joints =
            joints.iter().map(|&joint| clip.position(frame, joint).distance(clip.position(frame - 1, joint)));
        of_joints.sum::<f64>() / joints.len() as f64
    };
    (1..clip.frame_count()).map(moved).collect()
}

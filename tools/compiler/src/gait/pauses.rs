//! Pauses: where a body stands between two movements, both feet planted, hips at rest. A pause is shorter than the rests
//! that become idles ([`crate::gait::standing`]).
//!
//! A clip that is cut out of a longer one often begins or ends in the pose of the idle, already in motion. So an end of
//! the clip at which both feet stand is a pause too, if its pose is that of the standing example (`movements` asks this).
//! Times in frames of the clip; metres, seconds, radians.

use std::f64::consts::PI;
use std::ops::Range;

use crate::frame_runs::frame_runs;
use crate::gait::body_track::BodyTrack;
use crate::gait::foot_stance::{FootStance, stands_at};

/// Span over which a body at rest is measured, s.
const SPAN_S: f64 = 0.2;
/// Greatest speed of the hips of a body at rest, m/s.
const HIPS_MPS: f64 = 0.1;
/// Greatest turn rate of a body at rest, rad/s: 20 °/s. In a turn on the spot both feet stand between two steps.
const TURN_RAD_S: f64 = 20.0 * PI / 180.0;
/// Greatest speed of the hips at an end of a clip that may be cut out of an idle, m/s.
const CUT_HIPS_MPS: f64 = 0.4;

/// Least duration of a pose that is frozen, s.
const FROZEN_S: f64 = 0.05;
/// Least frame rate at which a frozen pose is told from a sudden stop, Hz.
const FROZEN_RATE_MIN_HZ: f64 = 24.0;
/// Greatest speed of the hips in a frozen pose, m/s: grounding moves it a little.
const FROZEN_MPS: f64 = 0.02;
/// Least speed of the hips beside a frozen pose, m/s: no body stops from it within a frame.
const FROZEN_FROM_MPS: f64 = 0.3;

/// Least distance of the ankles in a stride, m: bodies stand with feet side by side.
const STRIDE_ANKLES_M: f64 = 0.3;

/// A part of a clip in which the body stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pause {
    /// Its frames.
    pub(crate) frames: Range<usize>,
    /// It is one frame at an end of the clip, in which the body may already move.
    pub(crate) is_cut: bool,
}

/// The pauses within some frames of a clip, in order of time. `stances` are those of both feet.
pub(crate) fn pauses(track: &BodyTrack, stances: &[Vec<FootStance>; 2], frames: &Range<usize>) -> Vec<Pause> {
    let stands = |frame: usize| stances.iter().all(|side| stands_at(side, frame as f64));
    let rests = |frame: usize| {
        let (hips_mps, turn_rad_s) = speeds(track, frames, frame);
        stands(frame) && hips_mps < HIPS_MPS && turn_rad_s < TURN_RAD_S
    };
    let mut flags: Vec<bool> = frames.clone().map(rests).collect();
    let half = half_span(track);
    for frozen in frozen_walks(track, frames) {
        let (from, to) = (frozen.start.saturating_sub(half).max(frames.start), (frozen.end + half).min(frames.end));
        flags[from - frames.start..to - frames.start].fill(false);
    }
    let moved = |run: Range<usize>| frames.start + run.start..frames.start + run.end;
    let mut pauses: Vec<Pause> =
        frame_runs(&flags, true).into_iter().map(|run| Pause { frames: moved(run), is_cut: false }).collect();
    let is_cut = |frame: usize| stands(frame) && speeds(track, frames, frame).0 < CUT_HIPS_MPS;
    let (first, last) = (frames.start, frames.end - 1);
    if pauses.first().is_none_or(|pause| pause.frames.start > first) && is_cut(first) {
        pauses.insert(0, Pause { frames: first..first + 1, is_cut: true });
    }
    if pauses.last().is_none_or(|pause| pause.frames.end <= last) && is_cut(last) {
        pauses.push(Pause { frames: last..last + 1, is_cut: true });
    }
    pauses
}

/// Frames in which a walking body is frozen in a stride: a drop-out of the capture, or a stutter of its export.
fn frozen_walks(track: &BodyTrack, frames: &Range<usize>) -> Vec<Range<usize>> {
    let step_mps = |frame: usize| track.hips_m[frame].distance(track.hips_m[frame - 1]) * track.frame_rate_hz;
    let inner = frames.start + 1..frames.end;
    let still: Vec<bool> = inner.clone().map(|frame| step_mps(frame) < FROZEN_MPS).collect();
    let walks_beside = |run: &Range<usize>| {
        let before = (run.start > inner.start).then(|| step_mps(run.start - 1));
        let after = (run.end < inner.end).then(|| step_mps(run.end));
        let [left_m, right_m] = track.ankles_m[run.start];
        let walks = |speed_mps: Option<f64>| speed_mps.is_some_and(|speed_mps| speed_mps > FROZEN_FROM_MPS);
        left_m.distance(right_m) > STRIDE_ANKLES_M && walks(before) && walks(after)
    };
    let runs = frame_runs(&still, true).into_iter().map(|run| inner.start + run.start..inner.start + run.end);
    let is_long = |run: &Range<usize>| run.len() as f64 >= FROZEN_S * track.frame_rate_hz;
    runs.filter(|run| track.frame_rate_hz >= FROZEN_RATE_MIN_HZ && is_long(run)).filter(walks_beside).collect()
}

/// Half the frames over which a body at rest is measured.
fn half_span(track: &BodyTrack) -> usize {
    ((0.5 * SPAN_S * track.frame_rate_hz) as usize).max(1)
}

/// Speed of the hips (m/s) and turn rate (rad/s) about a frame, without its sign.
fn speeds(track: &BodyTrack, frames: &Range<usize>, frame: usize) -> (f64, f64) {
    let half = half_span(track);
    let before = frame.saturating_sub(half).max(frames.start);
    let after = (frame + half).min(frames.end - 1);
    let span_s = (after - before).max(1) as f64 / track.frame_rate_hz;
    let moved_m = track.hips_m[after].distance(track.hips_m[before]);
    (moved_m / span_s, (track.facing_rad[after] - track.facing_rad[before]).abs() / span_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait::performer_gait::own_clip;
    use crate::gait::windows::analyze_gait;
    use crate::synthetic::{SyntheticWalk, idle, performance, walk};

    #[test]
    fn bodies_pause_between_walks() {
        let part = |duration_s| walk("part", SyntheticWalk { duration_s, ..SyntheticWalk::default() });
        let clip = performance("capture", &[idle("part", 1.0), part(3.0), idle("part", 0.5), part(2.5)]);
        let (body, grounded) = own_clip(&clip);
        let stances = analyze_gait(&grounded, &body, &[]).stances[0].clone();
        let track = BodyTrack::of(&grounded, &body, |_| ());
        let found = pauses(&track, &stances, &(0..clip.frames.len()));
        let [first, second] = &found[..] else { panic!("{found:?}") };
        assert!(first.frames.start == 0 && !first.is_cut, "{first:?}");
        for (frame, wanted) in [(first.frames.end, 61), (second.frames.start, 242), (second.frames.end, 273)] {
            assert!(frame.abs_diff(wanted) <= 12, "{found:?}");
        }
    }

    #[test]
    fn a_frozen_stride_is_no_pause() {
        let mut clip = walk("part", SyntheticWalk { duration_s: 5.0, ..SyntheticWalk::default() });
        for at in [100, 130, 171] {
            let frozen = clip.frames[at].clone();
            clip.frames.splice(at..at, std::iter::repeat_n(frozen, 15));
        }
        let (body, grounded) = own_clip(&clip);
        let stances = analyze_gait(&grounded, &body, &[]).stances[0].clone();
        let track = BodyTrack::of(&grounded, &body, |_| ());
        let found = pauses(&track, &stances, &(0..clip.frames.len()));
        assert!(found.iter().all(|pause| pause.is_cut), "{found:?}");
    }
}

//! Corners: parts of a clip in which a body that walks turns sharply. Times in frames of the clip; metres, radians.

use std::f64::consts::PI;
use std::ops::{Range, RangeInclusive};

use serde::{Deserialize, Serialize};

use crate::frame_runs::frame_runs;
use crate::gait::body_track::BodyPath;
use crate::ground::root_arc::Rates;

/// Span over which turn rate and speed are measured, s: half a stride, over which the sway of the facing is small.
const SPAN_S: f64 = 0.5;
/// Least turn rate, rad/s: 45 °/s.
const RATE_MIN_RAD_S: f64 = PI / 4.0;
/// Least turn, rad: 45°.
const TURN_MIN_RAD: f64 = PI / 4.0;
/// Least speed of a body that walks, m/s; a slower one turns on the spot.
const SPEED_MIN_MPS: f64 = 0.3;

/// Share of a corner from which a window shows it.
pub(crate) const SHOWN_SHARE: f64 = 0.5;

/// Turn rates of a steady walk that turns as a corner does, divided by the corner's.
const ALIKE_RATES: RangeInclusive<f64> = 0.7..=1.4;

/// A sharp turn of a body that walks, in its clip.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Corner {
    /// First and last second, from the file's first frame.
    pub(crate) window_s: [f64; 2],
    /// Turn, rad; positive to the left.
    pub(crate) turn_rad: f64,
}

/// A sharp turn of a body that walks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SharpTurn {
    /// Its frames.
    pub(crate) frames: Range<usize>,
    /// Turn, rad; positive to the left.
    pub(crate) turn_rad: f64,
}

impl Corner {
    /// Whether a body at these rates walks and turns as in the corner.
    pub(crate) fn turns_alike(&self, rates: &Rates) -> bool {
        let rate_rad_s = self.turn_rad / (self.window_s[1] - self.window_s[0]);
        rates.speed_over_ground_mps() >= SPEED_MIN_MPS && ALIKE_RATES.contains(&(rates.turn_rate_rad_s / rate_rad_s))
    }

    /// Share of the corner that lies within a window, s.
    pub(crate) fn share_within(&self, [from_s, to_s]: [f64; 2]) -> f64 {
        let [first_s, last_s] = self.window_s;
        (last_s.min(to_s) - first_s.max(from_s)).max(0.0) / (last_s - first_s)
    }
}

/// The sharp turns within some frames of a path, in order of time.
pub(crate) fn sharp_turns(path: &BodyPath, frame_rate_hz: f64, frames: &Range<usize>) -> Vec<SharpTurn> {
    let half = ((0.5 * SPAN_S * frame_rate_hz) as usize).max(1);
    let ends = |frame: usize| [frame.saturating_sub(half).max(frames.start), (frame + half).min(frames.end - 1)];
    let per_s = |value: f64, [from, to]: [usize; 2]| value * frame_rate_hz / (to - from).max(1) as f64;
    let turn_rad = |[from, to]: [usize; 2]| path.facing_rad[to] - path.facing_rad[from];
    let turns = |frame: usize, side: f64| {
        let ends = ends(frame);
        let speed_mps = per_s(path.hips_m[ends[1]].distance(path.hips_m[ends[0]]), ends);
        side * per_s(turn_rad(ends), ends) >= RATE_MIN_RAD_S && speed_mps >= SPEED_MIN_MPS
    };
    let to_side = |side: f64| {
        let flags: Vec<bool> = frames.clone().map(|frame| turns(frame, side)).collect();
        frame_runs(&flags, true).into_iter().map(|run| frames.start + run.start..frames.start + run.end)
    };
    let sharp_turn = |run: Range<usize>| SharpTurn { turn_rad: turn_rad([run.start, run.end - 1]), frames: run };
    let mut found: Vec<SharpTurn> = to_side(1.0).chain(to_side(-1.0)).map(sharp_turn).collect();
    found.retain(|turn| turn.turn_rad.abs() >= TURN_MIN_RAD);
    found.sort_by_key(|turn| turn.frames.start);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait::body_track::BodyTrack;
    use crate::gait::performer_gait::own_clip;
    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{SyntheticWalk, performance, walk};

    fn part(turn_rate_rad_s: f64, duration_s: f64) -> HumanClip {
        walk("part", SyntheticWalk { duration_s, ..SyntheticWalk::at(1.0, turn_rate_rad_s, 0.0) })
    }

    /// The corners of a walk of some turn rates (rad/s) and durations (s): first and last second, and turn in degrees.
    fn found(parts: &[(f64, f64)]) -> Vec<([f64; 2], f64)> {
        let parts: Vec<HumanClip> = parts.iter().map(|&(rate, duration)| part(rate, duration)).collect();
        let clip = performance("capture", &parts);
        let (body, grounded) = own_clip(&clip);
        let track = BodyTrack::of(&grounded, &body, |_| ());
        let seconds = |frame: usize| frame as f64 / clip.frame_rate_hz;
        let frames = 0..track.frame_count();
        let path = BodyPath { hips_m: track.hips_m, facing_rad: track.facing_rad };
        sharp_turns(&path, clip.frame_rate_hz, &frames)
            .into_iter()
            .map(|corner| {
                ([seconds(corner.frames.start), seconds(corner.frames.end - 1)], corner.turn_rad.to_degrees())
            })
            .collect()
    }

    #[test]
    fn sharp_turns_of_a_walk_are_corners() {
        assert_eq!(found(&[(0.0, 2.0), (0.5, 3.0)]), []);
        let corners = found(&[(0.0, 2.0), (-1.4, 1.2), (0.0, 2.0), (1.2, 2.0)]);
        let [([from_s, to_s], right_deg), (_, left_deg)] = corners[..] else { panic!("{corners:?}") };
        assert!((from_s - 2.0).abs() < 0.3 && (to_s - 3.2).abs() < 0.3, "{corners:?}");
        assert!((-105.0..-70.0).contains(&right_deg) && (105.0..145.0).contains(&left_deg), "{corners:?}");
    }
}

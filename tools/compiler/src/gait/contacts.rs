//! Foot contacts of a clip, frame by frame, by height and by speed. Planted-foot slide is measured over them.
//!
//! The contact point of a foot is the lowest of heel, ball and toe tip, each above its own planted height. The points
//! lie on the sole where the clip has `…Sole` joints, else at the joints (ankle, ball, end of the toe). A foot is
//! planted while its contact point is low and slow (definition "Planted-foot slide" of `docs/definitions.md`; limits
//! and their tuning: `docs/tuning.md`). World frame: metres, Z up; one value a frame.

use glam::DVec3;

use crate::frame_runs::frame_runs;

/// Greatest height of a planted point above its planted height, m.
const HEIGHT_MAX_M: f64 = 0.025;
/// Greatest speed of a planted point of a body that stands, m/s.
const SPEED_MAX_MPS: f64 = 0.25;
/// Share of the body's speed that adds to [`SPEED_MAX_MPS`], for clips whose feet slide as they run.
const SPEED_MAX_SHARE: f64 = 0.15;
/// Share of a point's heights below its planted height: noise dips below it.
const PLANTED_PERCENTILE: f64 = 0.05;
/// Duration over which a planted height is measured, s: longer than a stride, so that it holds a stance.
const FLOOR_WINDOW_S: f64 = 1.6;
/// Half the span over which speeds are taken, s: noise then weighs the same at 24 and at 120 frames per second.
const SPEED_SPAN_S: f64 = 1.0 / 30.0;
/// Least duration of a touch that counts as planted, s.
const TOUCH_MIN_S: f64 = 0.05;
/// Least duration of a lift that counts as a swing, s; real swings last 0.3 s and more.
const LIFT_MIN_S: f64 = 0.1;
/// Least duration of a contact that counts as a step, s.
const CONTACT_MIN_S: f64 = 0.08;

/// The contacts of one foot, one flag a frame.
#[derive(Clone, Debug)]
pub(crate) struct ContactFrames {
    /// The foot is planted, as near to the definition as noise allows.
    pub(crate) planted: Vec<bool>,
    /// The foot is on the ground in one step; short lifts and slips count as contact. Steps take their middle from it.
    pub(crate) stepping: Vec<bool>,
}

/// The contacts of one foot, by reading. Its lenience multiplies both limits: 1 is the definition, more finds the steps
/// of noisy clips.
pub(crate) fn contact_readings<const N: usize>(
    feet: &[[DVec3; 3]],
    frame_rate_hz: f64,
    body_speed_mps: f64,
    leniences: [f64; N],
) -> [ContactFrames; N] {
    let lowest = lowest_points(feet, (FLOOR_WINDOW_S * frame_rate_hz) as usize);
    let span = ((SPEED_SPAN_S * frame_rate_hz + 0.5) as usize).max(1);
    leniences.map(|lenience| {
        let speed_max_mps = lenience * (SPEED_MAX_MPS + SPEED_MAX_SHARE * body_speed_mps);
        let touches = |(frame, &(point, height_m)): (usize, &(usize, f64))| {
            let (before, after) = (frame.saturating_sub(span), (frame + span).min(feet.len() - 1));
            let moved_m = (feet[after][point] - feet[before][point]).truncate().length();
            height_m < lenience * HEIGHT_MAX_M && moved_m * frame_rate_hz < speed_max_mps * (after - before) as f64
        };
        ContactFrames::of(lowest.iter().enumerate().map(touches).collect(), frame_rate_hz)
    })
}

impl ContactFrames {
    /// The contacts of a foot that touches the ground in some frames.
    fn of(mut stepping: Vec<bool>, frame_rate_hz: f64) -> Self {
        let mut planted = stepping.clone();
        flip_short_runs(&mut planted, true, TOUCH_MIN_S * frame_rate_hz);
        for contacts in [&mut planted, &mut stepping] {
            flip_short_runs(contacts, false, LIFT_MIN_S * frame_rate_hz);
            flip_short_runs(contacts, true, CONTACT_MIN_S * frame_rate_hz);
        }
        Self { planted, stepping }
    }
}

/// Index of the lowest of a foot's three points above its planted height, and its height above that (m), at each frame.
///
/// Planted heights are taken over `window` frames about each frame: the floor of a capture may slope.
fn lowest_points(feet: &[[DVec3; 3]], window: usize) -> Vec<(usize, f64)> {
    let mut lowest = vec![(0, f64::INFINITY); feet.len()];
    for point in 0..3 {
        let planted_m = planted_heights_m(feet, point, window);
        for ((lowest, foot), planted_m) in lowest.iter_mut().zip(feet).zip(planted_m) {
            let height_m = foot[point].z - planted_m;
            if point == 0 || height_m < lowest.1 {
                *lowest = (point, height_m);
            }
        }
    }
    lowest
}

/// Planted height of a point about each frame, m: a percentile of a sliding window, kept sorted, so that a frame costs
/// one search and one shift.
fn planted_heights_m(feet: &[[DVec3; 3]], point: usize, window: usize) -> Vec<f64> {
    let heights_m: Vec<f64> = feet.iter().map(|foot| foot[point].z).collect();
    let window = window.clamp(1, heights_m.len());
    let mut near_m = heights_m[..window].to_vec();
    near_m.sort_by(f64::total_cmp);
    let index = (PLANTED_PERCENTILE * window as f64) as usize;
    let mut percentiles_m = vec![near_m[index]];
    for (gone_m, new_m) in heights_m.iter().zip(&heights_m[window..]) {
        near_m.remove(near_m.partition_point(|height_m| height_m.total_cmp(gone_m).is_lt()));
        near_m.insert(near_m.partition_point(|height_m| height_m.total_cmp(new_m).is_lt()), *new_m);
        percentiles_m.push(near_m[index]);
    }
    let of_frame = |frame: usize| percentiles_m[frame.saturating_sub(window / 2).min(percentiles_m.len() - 1)];
    (0..feet.len()).map(of_frame).collect()
}

/// Flips inner runs of `value` that are shorter than `length` frames. The first and the last run of the clip may go on
/// outside of it.
fn flip_short_runs(flags: &mut [bool], value: bool, length: f64) {
    let inner = frame_runs(flags, value).into_iter().filter(|run| run.start > 0 && run.end < flags.len());
    for run in inner.collect::<Vec<_>>() {
        if (run.len() as f64) < length {
            flags[run].fill(!value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use motiondb::statistics::percentile;

    #[test]
    fn planted_heights_are_percentiles_of_sliding_windows() {
        // Repeated heights and both zeros are among them.
        let height_m =
            |frame: usize| (frame * frame % 97) as f64 * 0.01 - if frame.is_multiple_of(7) { 0.3 } else { -0.0 };
        let feet: Vec<[DVec3; 3]> = (0..300).map(|frame| [DVec3::new(0.0, 0.0, height_m(frame)); 3]).collect();
        for window in [1, 2, 20, 99, 300, 400] {
            let found = planted_heights_m(&feet, 0, window);
            let length = window.min(feet.len());
            for (frame, &found_m) in found.iter().enumerate() {
                let start = frame.saturating_sub(length / 2).min(feet.len() - length);
                let near_m = feet[start..start + length].iter().map(|foot| foot[0].z);
                assert_eq!(Some(found_m), percentile(near_m, PLANTED_PERCENTILE), "window {window}, frame {frame}");
            }
        }
    }

    #[test]
    fn short_lifts_close_and_short_contacts_vanish() {
        let frames = |text: &str| text.bytes().map(|b| b == b'#').collect::<Vec<bool>>();
        let mut planted = frames("##.....######.#......#.....##");
        flip_short_runs(&mut planted, false, 3.0);
        flip_short_runs(&mut planted, true, 3.0);
        assert_eq!(planted, frames("##.....########............##"));
    }
}

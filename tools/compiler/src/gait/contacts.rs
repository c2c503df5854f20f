//! Foot contacts of a clip, frame by frame: by height and by speed. Planted-foot slide is measured over them.
//!
//! A foot's contact point is the lowest of heel, ball and toe tip: on the sole where the clip had `…Sole` joints, else
//! at the joints (ankle, ball, end of the toe), each over its own planted height. The foot is planted while that point
//! is low and slow. World frame, metres.

use glam::DVec3;

/// Over its planted height a planted point lifts less than this, metres.
const HEIGHT_MAX_M: f64 = 0.025;
/// Speed of a planted point: this, and a share of the body's speed for clips that slide as they run, m/s.
const SPEED_MAX_MPS: f64 = 0.25;
const SPEED_MAX_SHARE: f64 = 0.15;
/// A point's planted height is this percentile of its heights: noise dips below it.
const PLANTED_PERCENTILE: f64 = 0.05;
/// It is found anew over this time: longer than a stride, so that every window holds a stance.
const FLOOR_WINDOW_S: f64 = 1.6;
/// Speeds are taken over ± this time, so that noise weighs the same at 24 and at 120 frames a second: one frame at 30.
const SPEED_SPAN_S: f64 = 1.0 / 30.0;
/// Seconds: a shorter touch is not planted, a shorter lift no swing (those last 0.3 s and more), a shorter contact no
/// step.
const TOUCH_MIN_S: f64 = 0.05;
const LIFT_MIN_S: f64 = 0.1;
const CONTACT_MIN_S: f64 = 0.08;

/// Which of a foot's three points is the lowest over its planted height, frame by frame, and how high it is. Planted
/// heights are taken over `window` frames about each frame: the floor of a capture may slope.
pub(crate) fn lowest_points(feet: &[[DVec3; 3]], window: usize) -> Vec<(usize, f64)> {
    let planted = [0, 1, 2].map(|point| planted_heights_m(feet, point, window));
    let lower = |a: (usize, f64), b: (usize, f64)| if b.1 < a.1 { b } else { a };
    (0..feet.len())
        .map(|frame| {
            let height = |point: usize| (point, feet[frame][point].z - planted[point][frame]);
            lower(lower(height(0), height(1)), height(2))
        })
        .collect()
}

/// Height at which a point is planted about each frame: the percentile of a window that slides over the heights, kept
/// sorted so that a frame costs one search and one shift.
fn planted_heights_m(feet: &[[DVec3; 3]], point: usize, window: usize) -> Vec<f64> {
    let heights: Vec<f64> = feet.iter().map(|foot| foot[point].z).collect();
    let window = window.clamp(1, heights.len());
    let mut near = heights[..window].to_vec();
    near.sort_by(f64::total_cmp);
    let index = (PLANTED_PERCENTILE * window as f64) as usize;
    let mut percentiles = vec![near[index]];
    for (gone, new) in heights.iter().zip(&heights[window..]) {
        near.remove(near.partition_point(|height| height.total_cmp(gone).is_lt()));
        near.insert(near.partition_point(|height| height.total_cmp(new).is_lt()), *new);
        percentiles.push(near[index]);
    }
    let of_frame = |frame: usize| percentiles[frame.saturating_sub(window / 2).min(percentiles.len() - 1)];
    (0..feet.len()).map(of_frame).collect()
}

/// One foot's contacts, frame by frame.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// Planted, as near to the definition as noise allows.
    pub planted: Vec<bool>,
    /// On the ground in one step, short lifts and slips included: what its middle is taken of.
    pub stepping: Vec<bool>,
}

/// The contacts of one foot. `lenience` multiplies both limits: 1 is the definition, more finds the steps of noisy
/// clips.
pub(crate) fn find(feet: &[[DVec3; 3]], frame_rate_hz: f64, body_speed_mps: f64, lenience: f64) -> Contacts {
    let speed_max_mps = lenience * (SPEED_MAX_MPS + SPEED_MAX_SHARE * body_speed_mps);
    let window = (FLOOR_WINDOW_S * frame_rate_hz) as usize;
    let span = ((SPEED_SPAN_S * frame_rate_hz + 0.5) as usize).max(1);
    let mut stepping: Vec<bool> = lowest_points(feet, window)
        .iter()
        .enumerate()
        .map(|(frame, &(point, height_m))| {
            let (before, after) = (frame.saturating_sub(span), (frame + span).min(feet.len() - 1));
            let moved = (feet[after][point] - feet[before][point]).truncate().length();
            height_m < lenience * HEIGHT_MAX_M && moved * frame_rate_hz < speed_max_mps * (after - before) as f64
        })
        .collect();
    let mut planted = stepping.clone();
    flip_short_runs(&mut planted, true, TOUCH_MIN_S * frame_rate_hz);
    for contacts in [&mut planted, &mut stepping] {
        flip_short_runs(contacts, false, LIFT_MIN_S * frame_rate_hz);
        flip_short_runs(contacts, true, CONTACT_MIN_S * frame_rate_hz);
    }
    Contacts { planted, stepping }
}

/// Runs of equal values: value, first frame, frame after the last.
pub(crate) fn runs(planted: &[bool]) -> Vec<(bool, usize, usize)> {
    let mut runs: Vec<(bool, usize, usize)> = Vec::new();
    for (frame, &value) in planted.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if run.0 == value => run.2 = frame + 1,
            _ => runs.push((value, frame, frame + 1)),
        }
    }
    runs
}

/// Flips inner runs of `value` shorter than `length` frames; the first and the last may go on outside the clip.
fn flip_short_runs(planted: &mut [bool], value: bool, length: f64) {
    let runs = runs(planted);
    for &(run_value, start, end) in runs.iter().skip(1).rev().skip(1) {
        if run_value == value && ((end - start) as f64) < length {
            planted[start..end].fill(!value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::root_motion::percentile;

    #[test]
    fn planted_heights_are_the_percentiles_of_all_windows() {
        // Repeated heights and both zeros are among them.
        let height_m =
            |frame: usize| (frame * frame % 97) as f64 * 0.01 - if frame.is_multiple_of(7) { 0.3 } else { -0.0 };
        let feet: Vec<[DVec3; 3]> = (0..300).map(|frame| [DVec3::new(0.0, 0.0, height_m(frame)); 3]).collect();
        for window in [1, 2, 20, 99, 300, 400] {
            let found = planted_heights_m(&feet, 0, window);
            let length = window.min(feet.len());
            for (frame, &found_m) in found.iter().enumerate() {
                let start = frame.saturating_sub(length / 2).min(feet.len() - length);
                let mut near: Vec<f64> = feet[start..start + length].iter().map(|foot| foot[0].z).collect();
                assert_eq!(found_m, percentile(&mut near, PLANTED_PERCENTILE), "window {window}, frame {frame}");
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

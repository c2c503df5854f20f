//! Contacts → stances: the instants at which a foot touches the ground and leaves it, finer than frames.
//!
//! Slide needs to know in which frames a foot is planted; an event of the gait is one instant. One stance is found for
//! each contact ([`crate::gait::contacts`]), its two ends by `contact_ends`. Stances with less than a swing between
//! them are one. Frames of the clip (may lie between frames), metres, seconds.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::frame_runs::frame_runs;
use crate::gait::contact_ends::{ContactLimits, ContactPoints, frame_of, ticks};

/// Least duration of a lift that counts as a swing, s, as in [`crate::gait::contacts`].
const LIFT_MIN_S: f64 = 0.1;

/// One contact of a foot with the ground, from heel strike to toe-off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FootStance {
    /// Frame of the heel strike, or of the first touch of any part of the foot; −∞ where it lies before the clip.
    pub strike_frame: f64,
    /// Frame of the toe-off, or of the last touch of any part of the foot; ∞ where it lies after the clip.
    pub off_frame: f64,
}

impl FootStance {
    /// The stance of a foot that never leaves the ground.
    pub const ALWAYS: Self = Self { strike_frame: f64::NEG_INFINITY, off_frame: f64::INFINITY };

    /// Depth of a frame in this stance: frames to its nearer end, negative outside.
    pub fn depth_frames(&self, frame: f64) -> f64 {
        (frame - self.strike_frame).min(self.off_frame - frame)
    }
}

/// Whether a foot with these stances, in order of time, stands at a frame.
pub(crate) fn stands_at(stances: &[FootStance], frame: f64) -> bool {
    let begun = stances.partition_point(|stance| stance.strike_frame <= frame);
    stances[..begun].last().is_some_and(|stance| frame <= stance.off_frame)
}

/// Depth of a frame in these stances, in order of time: seconds to the nearer end of the stance, negative outside of all.
pub(crate) fn depth_s(stances: &[FootStance], frame: f64, frame_rate_hz: f64) -> f64 {
    // Stances are in order of time: the nearest is the last that has begun, or the next.
    let next = stances.partition_point(|stance| stance.strike_frame <= frame);
    let nearest = &stances[next.saturating_sub(1)..(next + 1).min(stances.len())];
    let depths = nearest.iter().map(|stance| stance.depth_frames(frame));
    depths.fold(f64::NEG_INFINITY, f64::max) / frame_rate_hz
}

/// The stances of one foot, in order of time. `feet` holds heel on the sole, ball and toe tip at each frame, `planted`
/// whether the foot is planted. A toe tip that the source does not show (`shows_toe_end`) lands with the ball.
pub(crate) fn foot_stances(
    feet: &[[DVec3; 3]],
    shows_toe_end: bool,
    planted: &[bool],
    frame_rate_hz: f64,
    body_speed_mps: f64,
) -> Vec<FootStance> {
    let at_strike = ContactLimits::at_strike(body_speed_mps, shows_toe_end);
    let at_off = ContactLimits::at_off(body_speed_mps);
    let contacts = frame_runs(planted, true);
    let last = ticks(feet.len().saturating_sub(1));
    // The search for an end may go up to the middle of the swing before or after.
    let mid_swing = |before: usize| (ticks(contacts[before].end) + ticks(contacts[before + 1].start - 1)) / 2;
    let stance = |index: usize| {
        let frames = contacts[index].clone();
        let (first_tick, last_tick) = (ticks(frames.start), ticks(frames.end - 1));
        let points = ContactPoints::over(feet, frames, frame_rate_hz);
        let earliest = if index == 0 { 0 } else { mid_swing(index - 1) };
        let latest = if index + 1 < contacts.len() { mid_swing(index) } else { last };
        let strike_frame = points.end_frame(&at_strike, last_tick, first_tick, earliest);
        let off_frame = points.release_frame(points.end_frame(&at_off, first_tick, last_tick, latest), latest);
        FootStance {
            strike_frame: if strike_frame > 0.0 { strike_frame } else { f64::NEG_INFINITY },
            off_frame: if off_frame < frame_of(last) { off_frame } else { f64::INFINITY },
        }
    };
    joined((0..contacts.len()).map(stance), LIFT_MIN_S * frame_rate_hz)
}

/// Joins stances with less than a swing between them.
fn joined(stances: impl Iterator<Item = FootStance>, lift_frames: f64) -> Vec<FootStance> {
    let mut joined: Vec<FootStance> = Vec::new();
    for stance in stances {
        match joined.last_mut() {
            Some(before) if stance.strike_frame - before.off_frame < lift_frames => before.off_frame = stance.off_frame,
            _ => joined.push(stance),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait::contacts::contact_readings;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{self, SyntheticWalk};

    /// Pseudo-random displacement of up to `amplitude_m` along each axis, the same at every call.
    fn jitter_m(frame: usize, point: usize, amplitude_m: f64) -> DVec3 {
        let noise = |axis: usize| {
            let seed = libm::sin((frame * 9 + point * 3 + axis) as f64 * 12.9898) * 43758.5453;
            amplitude_m * (2.0 * (seed - libm::floor(seed)) - 1.0)
        };
        DVec3::new(noise(0), noise(1), noise(2))
    }

    /// The synthetic right foot is planted for 0.3 of a period of 1.1 s before and after 0.37, 1.37 … periods.
    #[track_caller]
    fn check_events(frame_rate_hz: f64, amplitude_m: f64, tolerance_s: f64) {
        let clip = synthetic::walk("walk", SyntheticWalk { frame_rate_hz, ..SyntheticWalk::default() });
        let foot = |(frame, pose): (usize, &HumanPose)| {
            let points = pose.forward_kinematics(&clip.body).landing_points_m(&clip.body, 1);
            [0, 1, 2].map(|point| points[point] + jitter_m(frame, point, amplitude_m))
        };
        let feet: Vec<[DVec3; 3]> = clip.frames.iter().enumerate().map(foot).collect();
        let [contacts] = contact_readings(&feet, frame_rate_hz, 1.2, [1.0]);
        let stances = foot_stances(&feet, true, &contacts.planted, frame_rate_hz, 1.2);
        assert_eq!(stances.len(), 4, "{stances:?}");
        for (step, stance) in stances.iter().enumerate() {
            let events_s = [stance.strike_frame, stance.off_frame].map(|frame| frame / frame_rate_hz);
            let exact_s = [0.07, 0.67].map(|cycles| 1.1 * (cycles + step as f64));
            for (found_s, exact_s) in events_s.into_iter().zip(exact_s) {
                let error_s = if found_s.is_finite() { found_s - exact_s } else { 0.0 };
                assert!(error_s.abs() < tolerance_s, "step {step} at {frame_rate_hz} Hz: {found_s} s, not {exact_s} s");
            }
        }
    }

    #[test]
    fn events_are_found_between_frames() {
        for frame_rate_hz in [24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0] {
            check_events(frame_rate_hz, 0.0, 0.02);
        }
    }

    #[test]
    fn jitter_moves_events_by_less_than_a_frame() {
        for frame_rate_hz in [24.0, 30.0, 60.0, 120.0] {
            for amplitude_m in [0.001, 0.002, 0.003] {
                check_events(frame_rate_hz, amplitude_m, 1.0 / 30.0);
            }
        }
    }

    /// A foot at rest that creeps at 0.45 m/s from 0.45 s on, lifts and swings from 0.5 s on, and lands at 0.9 s.
    fn creeping_foot(time_s: f64) -> [DVec3; 3] {
        let [creeps_s, swings_s] = [(time_s.min(0.9) - 0.45).max(0.0), (time_s.min(0.9) - 0.5).max(0.0)];
        let phase = std::f64::consts::TAU * swings_s / 0.4;
        let ahead_m = 0.45 * (creeps_s - swings_s) + 0.6 * (swings_s / 0.4 - libm::sin(phase) / std::f64::consts::TAU);
        let heel_m = DVec3::new(ahead_m, 0.0, 0.04 * (1.0 - libm::cos(phase)));
        [0.0, 0.15, 0.22].map(|along_m| heel_m + DVec3::X * along_m)
    }

    #[test]
    fn creeping_feet_leave_the_ground_when_they_swing() {
        for frame_rate_hz in [30.0, 60.0, 120.0] {
            let feet: Vec<[DVec3; 3]> =
                (0..(1.6 * frame_rate_hz) as usize).map(|frame| creeping_foot(frame as f64 / frame_rate_hz)).collect();
            let [contacts] = contact_readings(&feet, frame_rate_hz, 1.2, [1.0]);
            let off_s = foot_stances(&feet, true, &contacts.planted, frame_rate_hz, 1.2)[0].off_frame / frame_rate_hz;
            assert!((off_s - 0.5).abs() < 1.0 / 30.0, "at {frame_rate_hz} Hz: {off_s} s");
        }
    }

    /// A foot that comes down at 0.4 m/s with its sole 45° steep until its ball lands at 0.5 s, then turns flat. Its tip,
    /// straight ahead of the ball, is then below the ground: it lands earlier.
    fn steep_foot(time_s: f64) -> [DVec3; 3] {
        let pitch_rad = std::f64::consts::FRAC_PI_4 * (1.0 - (time_s - 0.5).clamp(0.0, 0.1) / 0.1);
        let height_m = (0.4 * (0.5 - time_s)).clamp(0.0, 0.08);
        let along = DVec3::new(libm::cos(pitch_rad), 0.0, -libm::sin(pitch_rad));
        [-0.15, 0.0, 0.06].map(|along_m| {
            let point_m = height_m * DVec3::Z + along_m * along;
            point_m.with_z(point_m.z.max(0.0))
        })
    }

    #[test]
    fn estimated_toe_tips_do_not_land() {
        let feet: Vec<[DVec3; 3]> = (0..90).map(|frame| steep_foot(f64::from(frame) / 60.0)).collect();
        let planted: Vec<bool> = (0..90).map(|frame| frame >= 30).collect();
        let strike_s =
            |shows_toe_end: bool| foot_stances(&feet, shows_toe_end, &planted, 60.0, 1.2)[0].strike_frame / 60.0;
        assert!((strike_s(false) - 0.5).abs() < 0.02, "{}", strike_s(false));
        assert!(strike_s(true) < 0.46, "{}", strike_s(true));
    }

    #[test]
    fn contacts_cut_by_the_clip_have_no_such_end() {
        let feet = vec![[DVec3::ZERO; 3]; 30];
        assert_eq!(foot_stances(&feet, true, &[true; 30], 30.0, 0.0), [FootStance::ALWAYS]);
    }

    #[test]
    fn depth_is_the_distance_to_the_nearer_end() {
        let stance = FootStance { strike_frame: 4.0, off_frame: 20.5 };
        assert_eq!([3.0, 6.0, 18.0, 22.0].map(|frame| stance.depth_frames(frame)), [-1.0, 2.0, 2.5, -1.5]);
        assert_eq!([3.0, 6.0, 18.0, 22.0].map(|frame| stands_at(&[stance], frame)), [false, true, true, false]);
    }
}

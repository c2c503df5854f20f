//! Standing bodies: how like each other their upper bodies are, how far they sway, and how soon they repeat.
//!
//! A body stands while both feet are planted and its root is slower than 3 cm/s.
//!
//! - Likeness: of two bodies that stand in the same frame, the root mean square angle between the rotations of their 13
//!   joints from spine to hands, relative to the parent; the median over pairs and frames, degrees. A frame each half
//!   second counts, and each body with the next four in order of ids.
//! - Sway: the diagonal of the box about the pelvis's path on the ground in 6 s of standing; the median, mm.
//! - Repeat: the shortest lag after which the pelvis moves as before to a tenth of its spread, beyond the first lag at
//!   which it moves otherwise by half of its spread, s.

use glam::{Quat, Vec2};
use motiondb::body::Joint;
use motiondb::statistics::median;
use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;
use crate::recording::frame::AgentFrame;

/// Joints of the upper body, from spine to hands, by index.
const UPPER_BODY: std::ops::RangeInclusive<usize> = Joint::SpineLower.index()..=Joint::RightHand.index();
/// Greatest speed of a root that stands, m/s.
const STILL_MPS: f32 = 0.03;
/// Bodies with which each body is compared.
const COMPARED: usize = 4;
/// Duration over which sway is taken, s.
const SWAY_S: f64 = 6.0;
/// Spread below which a body does not sway, m.
const MOTIONLESS_M: f64 = 2e-4;
/// Difference of a repeated motion, as a share of its spread.
const REPEATED_SHARE: f32 = 0.1;
/// Difference of another motion, as a share of the spread.
const OTHER_SHARE: f32 = 0.5;

/// Standing bodies of a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StandingBodies {
    /// Time for which bodies stand, for 2 s and more, minutes.
    pub minutes: f64,
    /// Median angle between the upper bodies of two bodies that stand, degrees; none where no two stand at once.
    pub likeness_deg: Option<f64>,
    /// Median sway of the pelvis in 6 s, mm; none where no body stands as long.
    pub sway_mm: Option<f64>,
    /// Median duration after which a standing body repeats its motion, s; none where none repeats it.
    pub repeat_s: Option<f64>,
}

/// Collects standing bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct StandingTally {
    minutes: f64,
    likenesses_deg: Vec<f64>,
    sways_mm: Vec<f64>,
    repeats_s: Vec<f64>,
}

impl StandingTally {
    /// Compares the upper bodies of the agents that stand in one frame.
    pub(crate) fn compare(&mut self, standing: &[&AgentFrame]) {
        for (index, one) in standing.iter().enumerate() {
            let others = standing[index + 1..].iter().take(COMPARED);
            self.likenesses_deg.extend(others.map(|other| upper_bodies_apart_deg(one, other)));
        }
    }

    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let velocities_mps = track.velocities_mps();
        let stands =
            |index: usize| track.samples[index].stands_on_both_feet() && velocities_mps[index].length() < STILL_MPS;
        for run in track.runs(stands).into_iter().filter(|run| run.len() >= track.count(2.0)) {
            self.minutes += run.len() as f64 * track.dt_s / 60.0;
            let path_m: Vec<Vec2> = track.samples[run].iter().map(|sample| sample.pelvis_m.truncate()).collect();
            let window = track.count(SWAY_S);
            self.sways_mm.extend(path_m.chunks_exact(window).map(|path_m| 1e3 * f64::from(diagonal_m(path_m))));
            self.repeats_s.extend(repeat(&path_m).map(|lag| lag as f64 * track.dt_s));
        }
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> StandingBodies {
        StandingBodies {
            minutes: self.minutes,
            likeness_deg: median(self.likenesses_deg.iter().copied()),
            sway_mm: median(self.sways_mm.iter().copied()),
            repeat_s: median(self.repeats_s.iter().copied()),
        }
    }
}

/// Root mean square angle between the joints of two upper bodies, degrees.
fn upper_bodies_apart_deg(one: &AgentFrame, other: &AgentFrame) -> f64 {
    let joints = one.pose.rotations[UPPER_BODY].iter().zip(&other.pose.rotations[UPPER_BODY]);
    let squares = joints.clone().map(|(a, b)| angle_rad(*a, *b) * angle_rad(*a, *b));
    (squares.sum::<f64>() / joints.len() as f64).sqrt().to_degrees()
}

/// Angle between two rotations, rad; exact for small ones too.
pub(crate) fn angle_rad(a: Quat, b: Quat) -> f64 {
    let between = a.conjugate() * b;
    2.0 * libm::atan2(f64::from(between.xyz().length()), f64::from(between.w.abs()))
}

/// Diagonal of the box about a path, m.
fn diagonal_m(path_m: &[Vec2]) -> f32 {
    let low_m = path_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high_m = path_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    (high_m - low_m).length()
}

/// The shortest lag, in frames, after which a path repeats; up to half of its length.
fn repeat(path_m: &[Vec2]) -> Option<usize> {
    let count = path_m.len() as f32;
    let mean_m = path_m.iter().sum::<Vec2>() / count;
    let spread_m2 = 2.0 * path_m.iter().map(|point_m| point_m.distance_squared(mean_m)).sum::<f32>() / count;
    if f64::from(spread_m2).sqrt() < MOTIONLESS_M {
        return None;
    }
    let differs = |lag: usize, share: f32| {
        let pairs = path_m.iter().zip(&path_m[lag..]);
        let sum_m2 = pairs.map(|(before, after)| before.distance_squared(*after)).sum::<f32>();
        sum_m2 / (path_m.len() - lag) as f32 > share * share * spread_m2
    };
    let last = path_m.len() / 2;
    let other = (1..=last).find(|&lag| differs(lag, OTHER_SHARE))?;
    (other..=last).find(|&lag| !differs(lag, REPEATED_SHARE))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn sway_and_repeat_of_a_circle() {
        let mut tally = StandingTally::default();
        tally.add(&track(14.0, |time_s, sample| {
            let (sine, cosine) = libm::sincos(TAU * time_s / 3.0);
            sample.pelvis_m.x = 0.01 * cosine as f32;
            sample.pelvis_m.y = 0.01 * sine as f32;
        }));
        let found = tally.finish();
        assert!((found.sway_mm.unwrap() - 20.0 * 2_f64.sqrt()).abs() < 0.1, "{found:?}");
        // A tenth of the spread is reached 1/40 of a turn before the whole one.
        assert!((found.repeat_s.unwrap() - 3.0).abs() < 0.1, "{found:?}");
        assert!((found.minutes - 14.0 / 60.0).abs() < 1e-6);
    }

    #[test]
    fn a_motionless_or_drifting_body_does_not_repeat() {
        let mut tally = StandingTally::default();
        tally.add(&track(14.0, |_, _| ()));
        tally.add(&track(14.0, |time_s, sample| sample.pelvis_m.x = 0.01 * time_s as f32));
        assert_eq!(tally.finish().repeat_s, None);
    }

    #[test]
    fn a_body_that_walks_does_not_stand() {
        let mut tally = StandingTally::default();
        tally.add(&track(14.0, |time_s, sample| sample.root_m.x = 0.5 * time_s as f32));
        tally.add(&track(14.0, |_, sample| sample.planted = [true, false]));
        assert_eq!(tally.finish(), StandingBodies::default());
    }

    #[test]
    fn likeness_is_the_angle_between_joints() {
        let (one, mut other) = (AgentFrame::default(), AgentFrame::default());
        other.pose.rotations[UPPER_BODY].fill(Quat::from_rotation_x(2_f32.to_radians()));
        let mut tally = StandingTally::default();
        tally.compare(&[&one, &other]);
        let found = tally.finish().likeness_deg.unwrap();
        assert!((found - 2.0).abs() < 1e-3, "{found}");
    }
}

//! Secondary motion of head and wrists in walks.
//!
//! Of each 2 s in which a body walks faster than 0.5 m/s and turns by less than 20°: the standard deviation of the
//! head's roll and pitch against the vertical, about the facing; and the root mean square of the angular acceleration of
//! each hand relative to its forearm, by second differences over 1/60 s (a time step where that is longer). Medians over
//! these intervals; degrees, rad/s².

use glam::{Quat, Vec3};
use motiondb::statistics::{mean, median, standard_deviation};
use serde::Serialize;

use crate::maths::angle::yaw;
use crate::measures::people::body_track::BodyTrack;

/// Duration of an interval, s: about two strides.
const INTERVAL_S: f64 = 2.0;
/// Least speed in an interval, m/s.
const WALKING_MPS: f32 = 0.5;
/// Greatest turn in an interval, rad.
const TURN_MAX_RAD: f64 = std::f64::consts::PI / 9.0;

/// Head and wrists of a crowd that walks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct UpperBodies {
    /// Number of intervals of 2 s.
    pub intervals: usize,
    /// Standard deviation of the head's roll, degrees; none without intervals.
    pub head_roll_deg: Option<f64>,
    /// Standard deviation of the head's pitch, degrees; none without intervals.
    pub head_pitch_deg: Option<f64>,
    /// Root mean square of the wrists' angular acceleration, rad/s²; none without intervals.
    pub wrist_acceleration_rad_s2: Option<f64>,
}

/// Roll, pitch and wrist acceleration of every interval.
#[derive(Clone, Debug, Default)]
pub(crate) struct UpperBodyTally {
    intervals: Vec<[f64; 3]>,
}

impl UpperBodyTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let (facings_rad, velocities_mps) = (track.facings_rad(), track.velocities_mps());
        let walks =
            track.runs(|index| velocities_mps[index].length() > WALKING_MPS && !track.samples[index].has_arrived);
        let length = track.count(INTERVAL_S);
        for walk in walks {
            for from in walk.clone().step_by(length).filter(|from| from + length <= walk.end) {
                let turned_rad = facings_rad[from + length - 1] - facings_rad[from];
                if turned_rad.abs() < TURN_MAX_RAD {
                    self.intervals.extend(interval(track, from, length));
                }
            }
        }
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> UpperBodies {
        let middle = |which: usize| median(self.intervals.iter().map(|interval| interval[which]));
        UpperBodies {
            intervals: self.intervals.len(),
            head_roll_deg: middle(0),
            head_pitch_deg: middle(1),
            wrist_acceleration_rad_s2: middle(2),
        }
    }
}

fn interval(track: &BodyTrack, from: usize, length: usize) -> Option<[f64; 3]> {
    let samples = &track.samples[from..from + length];
    // Roll tips the head's left up, pitch its front down.
    let tips = |axis: Vec3| {
        samples.iter().map(move |sample| {
            let head = yaw(sample.facing_rad).conjugate() * sample.head;
            f64::from(libm::asinf((head * axis).z.clamp(-1.0, 1.0))).to_degrees()
        })
    };
    let span = track.acceleration_span();
    let time_s = (span as f64 * track.dt_s) as f32;
    let squares = [0, 1].into_iter().flat_map(|side| {
        samples.windows(2 * span + 1).map(move |window| {
            let hand = |index: usize| window[index].hands[side];
            let rates = [rate_rad(hand(0), hand(span)), rate_rad(hand(span), hand(2 * span))];
            f64::from(((rates[1] - rates[0]) / (time_s * time_s)).length_squared())
        })
    });
    Some([standard_deviation(tips(Vec3::Y))?, standard_deviation(tips(Vec3::X))?, mean(squares)?.sqrt()])
}

/// Rotation vector from one rotation to another, in the frame of the joint's parent, rad.
fn rate_rad(from: Quat, to: Quat) -> Vec3 {
    let between = to * from.conjugate();
    let between = if between.w < 0.0 { -between } else { between };
    let sine = between.xyz().length();
    if sine < 1e-9 { Vec3::ZERO } else { between.xyz() * (2.0 * libm::atan2f(sine, between.w) / sine) }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn a_nodding_head_and_waving_hands() {
        // Roll by 2° and pitch by 3° at 1 Hz, wrists by 0.1 rad at 2 Hz; the body faces along y.
        let mut tally = UpperBodyTally::default();
        tally.add(&track(8.0, |time_s, sample| {
            let sine = |hz: f64| libm::sin(TAU * hz * time_s) as f32;
            sample.root_m.y = 1.2 * time_s as f32;
            sample.facing_rad = std::f32::consts::FRAC_PI_2;
            let pitch = Quat::from_rotation_y((3.0 * sine(1.0)).to_radians());
            let roll = Quat::from_rotation_x((2.0 * libm::cos(TAU * time_s) as f32).to_radians());
            sample.head = yaw(sample.facing_rad) * pitch * roll;
            sample.hands = [Quat::from_rotation_x(0.1 * sine(2.0)); 2];
        }));
        let found = tally.finish();
        assert_eq!(found.intervals, 4);
        let half = 0.5_f64.sqrt();
        assert!((found.head_roll_deg.unwrap() - 2.0 * half).abs() < 0.02, "{found:?}");
        assert!((found.head_pitch_deg.unwrap() - 3.0 * half).abs() < 0.02, "{found:?}");
        let wrists = 0.1 * (2.0 * TAU) * (2.0 * TAU) * half;
        assert!((found.wrist_acceleration_rad_s2.unwrap() - wrists).abs() < 0.05 * wrists, "{found:?}");
    }

    #[test]
    fn still_hands_do_not_accelerate() {
        let mut tally = UpperBodyTally::default();
        tally.add(&track(4.0, |time_s, sample| sample.root_m.x = time_s as f32));
        let found = tally.finish();
        assert_eq!((found.wrist_acceleration_rad_s2, found.head_roll_deg), (Some(0.0), Some(0.0)));
    }
}

//! Pivots of flat feet: how far a planted foot turns on the ground while the body turns.
//!
//! A planted foot is flat while its heel and ball differ in height by less than they do at its flattest, and 1 cm. Its
//! pivot is the change of its direction from the first to the last flat frame of a contact. A contact counts if it is
//! flat for 0.1 s or more and the facing turns by 60 °/s or more meanwhile. Degrees.

use motiondb::statistics::{mean, median};
use serde::Serialize;

use crate::maths::angle::wrap_rad;
use crate::measures::people::body_track::BodyTrack;

/// Difference in height of heel and ball of a flat foot beyond its least difference, m.
const FLAT_M: f32 = 0.01;
/// Least duration for which a foot is flat, s.
const FLAT_S: f64 = 0.1;
/// Least turn rate of a body that turns, rad/s.
const TURNING_RAD_S: f64 = std::f64::consts::PI / 3.0;

/// Pivots of the flat feet of bodies that turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FootPivots {
    /// Number of contacts.
    pub contacts: usize,
    /// Mean turn rate of the bodies, degrees/s; none without contacts.
    pub turn_rate_deg_s: Option<f64>,
    /// Median size of the pivot, degrees; none without contacts.
    pub pivot_deg: Option<f64>,
}

/// Turn rate (degrees/s) and pivot (degrees) of every contact.
#[derive(Clone, Debug, Default)]
pub(crate) struct FootPivotTally {
    contacts: Vec<[f64; 2]>,
}

impl FootPivotTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let facings_rad = track.facings_rad();
        for side in 0..2 {
            let tilt_m = |index: usize| track.samples[index].feet_tilt_m[side].abs();
            for contact in track.runs(|index| track.samples[index].planted[side]) {
                let flattest_m = contact.clone().map(tilt_m).fold(f32::INFINITY, f32::min);
                let is_flat = |index: &usize| tilt_m(*index) < flattest_m + FLAT_M;
                let (Some(first), Some(last)) = (contact.clone().find(is_flat), contact.clone().rfind(is_flat)) else {
                    continue;
                };
                let duration_s = (last - first) as f64 * track.dt_s;
                let rate_rad_s = (facings_rad[last] - facings_rad[first]).abs() / duration_s;
                if duration_s >= FLAT_S && rate_rad_s >= TURNING_RAD_S {
                    let direction_rad = |index: usize| track.samples[index].feet_rad[side];
                    let pivot_rad = wrap_rad(direction_rad(last) - direction_rad(first)).abs();
                    self.contacts.push([rate_rad_s.to_degrees(), f64::from(pivot_rad).to_degrees()]);
                }
            }
        }
    }

    /// The figures of all contacts.
    pub(crate) fn finish(&self) -> FootPivots {
        FootPivots {
            contacts: self.contacts.len(),
            turn_rate_deg_s: mean(self.contacts.iter().map(|contact| contact[0])),
            pivot_deg: median(self.contacts.iter().map(|contact| contact[1])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn a_foot_pivots_by_what_it_turns_while_flat() {
        // Contacts of half a second; the body turns by 2 rad/s, the flat foot by 0.1 rad/s. The heel is up at the end.
        let mut tally = FootPivotTally::default();
        tally.add(&track(4.0, |time_s, sample| {
            let in_step_s = time_s.rem_euclid(1.0);
            sample.facing_rad = 2.0 * time_s as f32;
            sample.planted = [in_step_s < 0.5, true];
            sample.feet_rad = [if in_step_s < 0.4 { 0.1 * in_step_s as f32 } else { 1.0 }, 0.0];
            sample.feet_tilt_m = [if in_step_s < 0.4 { 0.0 } else { -0.05 }, 0.0];
        }));
        let found = tally.finish();
        assert_eq!(found.contacts, 5);
        // Four contacts of the left foot, one of the right one that does not pivot.
        assert!((found.pivot_deg.unwrap() - 0.0387_f64.to_degrees()).abs() < 0.1, "{found:?}");
        assert!((found.turn_rate_deg_s.unwrap() - 2_f64.to_degrees()).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn a_foot_of_a_body_that_does_not_turn_does_not_count() {
        let mut tally = FootPivotTally::default();
        tally.add(&track(2.0, |time_s, sample| sample.feet_rad[0] = time_s as f32));
        assert_eq!(tally.finish(), FootPivots::default());
    }
}

//! Shanks that pass through each other: moments in which the axes of a body's shanks come too near.
//!
//! The limit is 7 cm for an adult's shanks, with radii of 4.9 cm: 0.71 times the sum of the radii for any body. Frames
//! that are at most 0.2 s apart are one incident; per minute before arrival.

use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;
use crate::measures::people::incident::{Incident, IncidentKind};
use crate::measures::people::steps::pelvis_lurch::ONE_INCIDENT_S;

/// Least distance of the axes, divided by the sum of the radii: 7 cm of an adult of 1.755 m.
const APART_MIN: f32 = 0.07 / (2.0 * 0.028 * 1.755);

/// Shanks of a crowd that come too near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ShankGaps {
    /// Number of incidents.
    pub count: usize,
    /// Incidents per agent-minute before arrival; none of a crowd that has arrived.
    pub per_minute: Option<f64>,
    /// Least distance of the axes, divided by the sum of the radii of the shanks; none without frames.
    pub least_over_radii: Option<f64>,
}

/// Counts incidents.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShankGapTally {
    /// The incidents.
    pub(crate) incidents: Vec<Incident>,
    minutes: f64,
    least: Option<f32>,
}

impl ShankGapTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let under_way = || track.samples.iter().enumerate().filter(|(_, sample)| !sample.has_arrived);
        let near = under_way().filter(|(_, sample)| sample.shanks_apart < APART_MIN).map(|(index, _)| index);
        self.incidents.extend(Incident::of_track(IncidentKind::ShanksTooNear, track, near, ONE_INCIDENT_S));
        self.minutes += track.minutes();
        self.least = under_way().map(|(_, sample)| sample.shanks_apart).chain(self.least).reduce(f32::min);
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> ShankGaps {
        let count = self.incidents.len();
        let per_minute = (self.minutes > 0.0).then(|| count as f64 / self.minutes);
        ShankGaps { count, per_minute, least_over_radii: self.least.map(f64::from) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn near_shanks_are_counted_before_arrival() {
        let mut tally = ShankGapTally::default();
        tally.add(&track(6.0, |time_s, sample| {
            let is_near = (1.0..1.2).contains(&time_s) || time_s > 3.1;
            sample.shanks_apart = if is_near { 0.5 } else { 1.5 };
            sample.has_arrived = time_s >= 3.0;
        }));
        let found = tally.finish();
        assert_eq!((found.count, found.least_over_radii), (1, Some(0.5)));
        assert!((found.per_minute.unwrap() - 20.0).abs() < 0.2, "{found:?}");
    }
}

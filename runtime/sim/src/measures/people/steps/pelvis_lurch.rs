//! Lurches of the pelvis: moments in which it accelerates up or down as in no walk.
//!
//! The vertical acceleration is the second difference of the pelvis's height over 1/60 s (a time step where that is
//! longer), of bodies that walk, stop and stand. Frames above 18 m/s² that are at most 0.2 s apart are one lurch. Per
//! minute in which an agent that has not arrived is faster than 0.3 m/s; m/s².

use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;
use crate::measures::people::incident::{Incident, IncidentKind};

/// Acceleration of a lurch, m/s².
const LURCH_MPS2: f64 = 18.0;
/// Least speed of a body that walks, m/s.
const WALKING_MPS: f32 = 0.3;
/// Distance of frames that are one incident, s.
pub(crate) const ONE_INCIDENT_S: f64 = 0.2;

/// Lurches of a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PelvisLurches {
    /// Number of lurches.
    pub count: usize,
    /// Lurches per minute in which an agent walks; none where none walks.
    pub per_minute: Option<f64>,
    /// Greatest vertical acceleration, m/s².
    pub greatest_mps2: f64,
}

/// Counts lurches.
#[derive(Clone, Debug, Default)]
pub(crate) struct PelvisLurchTally {
    /// The lurches.
    pub(crate) incidents: Vec<Incident>,
    minutes: f64,
    greatest_mps2: f64,
}

impl PelvisLurchTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let (span, velocities_mps) = (track.acceleration_span(), track.velocities_mps());
        let time_s = span as f64 * track.dt_s;
        let last = track.samples.len().saturating_sub(span);
        let walks = |index: &usize| !track.samples[*index].has_arrived && velocities_mps[*index].length() > WALKING_MPS;
        self.minutes += (span..last).filter(walks).count() as f64 * track.dt_s / 60.0;
        let height_m = |index: usize| f64::from(track.samples[index].pelvis_m.z);
        let acceleration_mps2 = |index: usize| {
            let bend_m = height_m(index - span) - 2.0 * height_m(index) + height_m(index + span);
            bend_m.abs() / (time_s * time_s)
        };
        self.greatest_mps2 = (span..last).map(acceleration_mps2).fold(self.greatest_mps2, f64::max);
        let lurches = (span..last).filter(|index| acceleration_mps2(*index) > LURCH_MPS2);
        self.incidents.extend(Incident::of_track(IncidentKind::Lurch, track, lurches, ONE_INCIDENT_S));
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> PelvisLurches {
        let count = self.incidents.len();
        let per_minute = (self.minutes > 0.0).then(|| count as f64 / self.minutes);
        PelvisLurches { count, per_minute, greatest_mps2: self.greatest_mps2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// A body at a speed whose pelvis drops by 1 cm at once at 2 s and rises at 2.1 s and at 4 s.
    fn lurches_at(speed_mps: f32) -> PelvisLurches {
        let mut tally = PelvisLurchTally::default();
        tally.add(&track(6.0, |time_s, sample| {
            sample.root_m.x = speed_mps * time_s as f32;
            sample.pelvis_m.z = 0.9 - 0.01 * f32::from(u8::from((2.0..2.1).contains(&time_s) || time_s > 4.0));
        }));
        tally.finish()
    }

    #[test]
    fn near_jumps_are_one_lurch() {
        let found = lurches_at(1.0);
        assert_eq!(found.count, 2);
        // 1 cm in 1/60 s.
        assert!((found.greatest_mps2 - 36.0).abs() < 0.1, "{found:?}");
        assert!((found.per_minute.unwrap() - 20.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn bodies_that_stand_lurch_but_walk_for_no_minute() {
        let found = lurches_at(0.1);
        assert_eq!((found.count, found.per_minute), (2, None));
    }
}

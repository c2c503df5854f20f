//! Turns as no person makes them: sudden turns of the body, turns to and fro, and turns of the head that are too fast.
//!
//! - Sudden turn: the facing changes by more than 60° in 0.6 s.
//! - To and fro: within 1.5 s the facing turns by more than 20° to one side and by more than 20° back.
//! - Fast head: the direction of the head turns faster than 250 °/s, over 1/60 s (a time step where that is longer).
//!
//! Frames that are at most 0.6, 1.5 and 0.2 s apart are one incident; per agent-minute before arrival. A recording does
//! not say which glances a scenario commands.

use glam::{Vec2, Vec3};
use serde::Serialize;

use crate::maths::angle::angle_between_rad;
use crate::measures::people::body_track::BodyTrack;
use crate::measures::people::incident::{Incident, IncidentKind};

/// Angle of a sudden turn, rad, and its duration, s.
const SUDDEN: (f64, f64) = (std::f64::consts::PI / 3.0, 0.6);
/// Angle of a turn to and fro, rad, and its duration, s.
const TO_AND_FRO: (f64, f64) = (std::f64::consts::PI / 9.0, 1.5);
/// Turn rate of a fast head, rad/s.
const FAST_HEAD_RAD_S: f32 = 250.0 * std::f32::consts::PI / 180.0;
/// Distance of frames in which one turn of the head is fast, s.
const ONE_FAST_HEAD_S: f64 = 0.2;

/// Turns of a crowd, per agent-minute before arrival; none of a crowd that has arrived.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Turning {
    /// Sudden turns per agent-minute.
    pub sudden_per_minute: Option<f64>,
    /// Turns to and fro per agent-minute.
    pub to_and_fro_per_minute: Option<f64>,
    /// Fast turns of the head per agent-minute.
    pub fast_head_per_minute: Option<f64>,
}

/// Counts turns.
#[derive(Clone, Debug, Default)]
pub(crate) struct TurningTally {
    /// Sudden turns, turns to and fro, fast turns of the head, body by body.
    pub(crate) incidents: Vec<Incident>,
    minutes: f64,
}

impl TurningTally {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let facings_rad = track.facings_rad();
        let under_way = |index: &usize| !track.samples[*index].has_arrived;
        let mut add = |kind: IncidentKind, gap_s: f64, found: &dyn Fn(usize) -> bool| {
            let samples = (0..track.samples.len()).filter(under_way).filter(|&index| found(index));
            self.incidents.extend(Incident::of_track(kind, track, samples, gap_s));
        };
        let [sudden_span, fro_span] = [SUDDEN.1, TO_AND_FRO.1].map(|duration_s| track.count(duration_s));
        add(IncidentKind::SuddenTurn, SUDDEN.1, &|index| turns_suddenly(&facings_rad, index, sudden_span));
        add(IncidentKind::ToAndFro, TO_AND_FRO.1, &|index| turns_to_and_fro(&facings_rad, index, fro_span));
        add(IncidentKind::FastHead, ONE_FAST_HEAD_S, &|index| turns_head_fast(track, index));
        self.minutes += track.minutes();
    }

    /// The figures of all bodies.
    pub(crate) fn finish(&self) -> Turning {
        let per_minute = |kind: IncidentKind| {
            let count = self.incidents.iter().filter(|incident| incident.kind == kind).count();
            (self.minutes > 0.0).then(|| count as f64 / self.minutes)
        };
        Turning {
            sudden_per_minute: per_minute(IncidentKind::SuddenTurn),
            to_and_fro_per_minute: per_minute(IncidentKind::ToAndFro),
            fast_head_per_minute: per_minute(IncidentKind::FastHead),
        }
    }
}

/// Whether the facing turns suddenly from a frame on.
fn turns_suddenly(facings_rad: &[f64], from: usize, span: usize) -> bool {
    facings_rad.get(from + span).is_some_and(|later_rad| (later_rad - facings_rad[from]).abs() > SUDDEN.0)
}

/// Whether a frame lies between a turn and a turn back that both fit into the span.
fn turns_to_and_fro(facings_rad: &[f64], at: usize, span: usize) -> bool {
    [1.0, -1.0].into_iter().any(|side| {
        let off = |index: &usize| side * (facings_rad[at] - facings_rad[*index]) > TO_AND_FRO.0;
        let Some(before) = (at.saturating_sub(span)..at).rfind(|index| off(index)) else { return false };
        let latest = (before + span).min(facings_rad.len() - 1);
        (at..=latest).any(|index| off(&index))
    })
}

/// Whether the head turns fast after a frame. A head that looks up or down has no direction.
fn turns_head_fast(track: &BodyTrack, from: usize) -> bool {
    let span = track.acceleration_span();
    let Some(after) = track.samples.get(from + span) else { return false };
    let [before, after] = [&track.samples[from], after].map(|sample| (sample.head * Vec3::X).truncate());
    let level = |direction: Vec2| direction.length() > 0.5;
    let turned_rad = angle_between_rad(before, after).abs();
    level(before) && level(after) && turned_rad > FAST_HEAD_RAD_S * (span as f64 * track.dt_s) as f32
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// Incidents of a body whose facing and head are functions of time, rad; one minute.
    fn turning(facing_rad: impl Fn(f64) -> f64, head_rad: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut tally = TurningTally::default();
        tally.add(&track(60.0, |time_s, sample| {
            sample.facing_rad = facing_rad(time_s) as f32;
            sample.head = Quat::from_rotation_z(head_rad(time_s) as f32);
        }));
        let found = tally.finish();
        [found.sudden_per_minute, found.to_and_fro_per_minute, found.fast_head_per_minute].map(Option::unwrap)
    }

    /// A turn by 1 rad at a rate from a time on.
    fn turn(time_s: f64, from_s: f64, rate_rad_s: f64) -> f64 {
        ((time_s - from_s) * rate_rad_s).clamp(0.0, 1.0)
    }

    #[test]
    fn a_turn_is_sudden_by_its_rate() {
        // 1 rad and 1.2 rad: the limit is π/3 = 1.05 rad.
        assert_eq!(turning(|time_s| 1.2 * turn(time_s, 9.0, 4.0), |_| 0.0), [1.0, 0.0, 0.0]);
        assert_eq!(turning(|time_s| 1.2 * turn(time_s, 9.0, 1.0), |_| 0.0), [0.0; 3]);
        assert_eq!(turning(|time_s| turn(time_s, 9.0, 4.0), |_| 0.0), [0.0; 3]);
    }

    #[test]
    fn a_turn_and_its_return_are_one_incident() {
        let there_and_back =
            |pause_s: f64| move |time_s: f64| 0.6 * (turn(time_s, 9.0, 2.0) - turn(time_s, 9.5 + pause_s, 2.0));
        assert_eq!(turning(there_and_back(0.3), |_| 0.0)[1], 1.0);
        assert_eq!(turning(there_and_back(1.5), |_| 0.0)[1], 0.0);
    }

    #[test]
    fn a_head_is_fast_by_its_rate() {
        assert_eq!(turning(|_| 0.0, |time_s| turn(time_s, 9.0, 4.5))[2], 1.0);
        assert_eq!(turning(|_| 0.0, |time_s| turn(time_s, 9.0, 4.2))[2], 0.0);
    }
}

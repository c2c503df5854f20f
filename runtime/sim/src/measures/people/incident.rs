//! Incidents: the moments that the measures of people count, so that they can be found and looked at.

use std::io::{self, Write};
use std::ops::RangeInclusive;

use glam::Vec2;

use crate::measures::people::body_track::{BodyTrack, spans};

/// What a body does in an incident.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IncidentKind {
    /// Its pelvis lurches.
    Lurch,
    /// Its shanks come too near.
    ShanksTooNear,
    /// It turns suddenly.
    SuddenTurn,
    /// It turns to and fro.
    ToAndFro,
    /// Its head turns too fast.
    FastHead,
}

impl IncidentKind {
    /// The name in a table.
    pub fn name(self) -> &'static str {
        match self {
            IncidentKind::Lurch => "lurch",
            IncidentKind::ShanksTooNear => "shanks_too_near",
            IncidentKind::SuddenTurn => "sudden_turn",
            IncidentKind::ToAndFro => "to_and_fro",
            IncidentKind::FastHead => "fast_head",
        }
    }
}

/// One incident of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Incident {
    /// What the body does.
    pub kind: IncidentKind,
    /// Id of the agent.
    pub agent: usize,
    /// Frames of the recording, from the first to the last.
    pub frames: RangeInclusive<usize>,
    /// Time of the first and the last frame after the start of the recording, s.
    pub times_s: [f64; 2],
    /// Root in the first frame, world, m.
    pub root_m: Vec2,
}

impl Incident {
    /// The incidents of a body, given the samples that a measure counts, in order. Samples that are at most `gap_s` apart
    /// are one incident.
    pub(crate) fn of_track(
        kind: IncidentKind,
        track: &BodyTrack,
        samples: impl Iterator<Item = usize>,
        gap_s: f64,
    ) -> impl Iterator<Item = Self> {
        spans(samples, track.count(gap_s)).into_iter().map(move |span| {
            let [first, last] = [*span.start(), *span.end()];
            Self {
                kind,
                agent: track.agent,
                frames: track.frame(first)..=track.frame(last),
                times_s: [first, last].map(|index| track.time_s(index)),
                root_m: track.samples[first].root_m,
            }
        })
    }
}

/// Writes incidents as a table, in their order: CSV (RFC 4180), the first line names the columns.
///
/// # Errors
/// If writing fails.
pub fn write_incidents(incidents: &[Incident], out: &mut impl Write) -> io::Result<()> {
    write!(out, "incident,agent,first_frame,last_frame,first_s,last_s,x_m,y_m\r\n")?;
    for Incident { kind, agent, frames, times_s: [first_s, last_s], root_m } in incidents {
        let (first, last) = (frames.start(), frames.end());
        write!(out, "{},{agent},{first},{last},{first_s:.6},{last_s:.6},", kind.name())?;
        write!(out, "{:.6},{:.6}\r\n", root_m.x, root_m.y)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    #[test]
    fn incidents_name_agent_and_frames_of_the_recording() {
        let body = track(4.0, |time_s, sample| sample.root_m = Vec2::new(time_s as f32, -0.5));
        let body = BodyTrack { agent: 7, start_s: 2.0, ..body };
        let near = [60, 63, 90].into_iter();
        let incidents: Vec<Incident> = Incident::of_track(IncidentKind::ShanksTooNear, &body, near, 0.2).collect();
        let mut table = Vec::new();
        write_incidents(&incidents, &mut table).unwrap();
        let rows = String::from_utf8(table).unwrap();
        let expected = [
            "shanks_too_near,7,180,183,3.000000,3.050000,1.000000,-0.500000",
            "shanks_too_near,7,210,210,3.500000,3.500000,1.500000,-0.500000",
        ];
        assert_eq!(rows.lines().skip(1).collect::<Vec<_>>(), expected);
    }
}

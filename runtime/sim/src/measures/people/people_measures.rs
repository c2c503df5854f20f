//! The measures of people, collected from the tracks of all bodies.

use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;
use crate::measures::people::conduct::{QueueTally, Queues, Turning, TurningTally, UpperBodies, UpperBodyTally};
use crate::measures::people::incident::Incident;
use crate::measures::people::individuals::{
    CadenceSpread, Cadences, FirstStepTally, FirstSteps, PhaseOrder, PhaseOrders, StandingBodies, StandingTally,
};
use crate::measures::people::sole_slide::SoleSlide;
use crate::measures::people::steps::{
    FootPivotTally, FootPivots, PelvisLurchTally, PelvisLurches, ShankGapTally, ShankGaps, StartTally, Starts,
    StopTally, Stops, SwingClass, SwingTally,
};

/// The measures of people of one recording, under the keys of `fbcrowd measure --people --json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PeopleMeasures {
    /// Time before arrival, agent-minutes.
    pub agent_minutes: f64,
    /// Phase order at 1, 3 and 8 s.
    pub phase_order: Vec<PhaseOrder>,
    /// First steps after the start.
    pub first_steps: FirstSteps,
    /// Cadence at equal speed.
    pub cadence: CadenceSpread,
    /// Swings of steps of 15–30 cm and of 30–60 cm.
    pub swings: Vec<SwingClass>,
    /// Starts from rest.
    pub starts: Starts,
    /// Stops.
    pub stops: Stops,
    /// Standing bodies.
    pub standing: StandingBodies,
    /// Lurches of the pelvis.
    pub pelvis_lurches: PelvisLurches,
    /// Shanks that come too near.
    pub shank_gaps: ShankGaps,
    /// Turns as no person makes them.
    pub turning: Turning,
    /// Time in queues.
    pub queues: Queues,
    /// Head and wrists in walks.
    pub upper_bodies: UpperBodies,
    /// Pivots of flat feet.
    pub foot_pivots: FootPivots,
    /// Slide of planted feet before arrival.
    pub slide: SoleSlide,
    /// The moments that are counted above, in the order of agents and times.
    #[serde(skip)]
    pub incidents: Vec<Incident>,
}

/// Adds up the measures of bodies, one by one.
#[derive(Clone, Debug, Default)]
pub struct PeopleTally {
    agent_minutes: f64,
    phase_orders: PhaseOrders,
    first_steps: FirstStepTally,
    cadences: Cadences,
    swings: SwingTally,
    starts: StartTally,
    stops: StopTally,
    pub(crate) standing: StandingTally,
    pelvis_lurches: PelvisLurchTally,
    shank_gaps: ShankGapTally,
    turning: TurningTally,
    queues: QueueTally,
    upper_bodies: UpperBodyTally,
    foot_pivots: FootPivotTally,
}

impl PeopleTally {
    /// Adds a body.
    pub fn add(&mut self, track: &BodyTrack) {
        self.agent_minutes += track.minutes();
        self.phase_orders.add(track);
        self.first_steps.add(track);
        self.cadences.add(track);
        self.swings.add(track);
        self.starts.add(track);
        self.stops.add(track);
        self.standing.add(track);
        self.pelvis_lurches.add(track);
        self.shank_gaps.add(track);
        self.turning.add(track);
        self.queues.add(track);
        self.upper_bodies.add(track);
        self.foot_pivots.add(track);
    }

    /// The measures of all bodies, with the slide of their feet.
    pub fn finish(&self, slide: SoleSlide) -> PeopleMeasures {
        let Self { pelvis_lurches, shank_gaps, turning, .. } = self;
        let mut incidents = [&*pelvis_lurches.incidents, &shank_gaps.incidents, &turning.incidents].concat();
        incidents.sort_by_key(|incident| (incident.agent, *incident.frames.start()));
        PeopleMeasures {
            agent_minutes: self.agent_minutes,
            phase_order: self.phase_orders.finish(),
            first_steps: self.first_steps.finish(),
            cadence: self.cadences.finish(),
            swings: self.swings.finish(),
            starts: self.starts.finish(),
            stops: self.stops.finish(),
            standing: self.standing.finish(),
            pelvis_lurches: self.pelvis_lurches.finish(),
            shank_gaps: self.shank_gaps.finish(),
            turning: self.turning.finish(),
            queues: self.queues.finish(),
            upper_bodies: self.upper_bodies.finish(),
            foot_pivots: self.foot_pivots.finish(),
            slide,
            incidents,
        }
    }
}

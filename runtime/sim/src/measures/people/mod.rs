//! Measures of people: whether bodies move as people do, and differ as people do.
//!
//! Enters: frames of a running simulation, a recording, or the poses of a motion capture, all as [`BodyTrack`]s of final
//! poses. Leaves: [`PeopleMeasures`]. docs/measures.md defines each.
//!
//! Read `body_track` (a body over time), then the measures: `individuals`, `steps`, `conduct`; `incident` says where to look,
//! `people_measures` collects all, `people_measuring` makes tracks of frames, `sole_slide` measures feet at two places.

pub(crate) mod body_track;
pub(crate) mod conduct;
pub(crate) mod incident;
pub(crate) mod individuals;
pub(crate) mod people_measures;
pub(crate) mod people_measuring;
pub(crate) mod sole_slide;
pub(crate) mod steps;

pub use body_track::{BodySample, BodyTrack};
pub use conduct::{Queues, Turning, UpperBodies, shoulder_turn_deg};
pub use incident::{Incident, IncidentKind, write_incidents};
pub use individuals::{CadenceSpread, FirstSteps, PhaseOrder, StandingBodies};
pub use people_measures::{PeopleMeasures, PeopleTally};
pub use people_measuring::{PeopleMeasuring, measure_people};
pub use sole_slide::SoleSlide;
pub use steps::{FootPivots, PelvisLurches, ShankGaps, Starts, Stops, SwingClass};

//! The motion of a gait: from its plan to the frames of a clip.
//!
//! Enters: a [`GaitPlan`](crate::plan::GaitPlan) and its variation. Leaves: [`ClipPose`](crate::body::ClipPose)s.
//! Between them everything is in the frame of the moving root (x forward, y left, z up, metres, radians).
//!
//! Read in the order of the work: `footprint` and `steps` (where feet stand), `foot_roll` (on the ground), `pelvis`
//! (over the feet), `swing` (in the air), `upper_body`; `stepping` puts them together, `idle` stands.

pub(crate) mod foot_roll;
pub(crate) mod footprint;
pub(crate) mod idle;
pub(crate) mod pelvis;
pub(crate) mod stepping;
pub(crate) mod steps;
pub(crate) mod swing;
pub(crate) mod upper_body;

pub(crate) use idle::idle_frames;
pub(crate) use stepping::{Playback, stepping_frames};

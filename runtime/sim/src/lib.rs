//! The simulation: one step in the order of the paper's Fig. 2, told in [`step`].

pub mod hms;
pub mod mcn;
pub mod params;
pub mod plan;
pub mod recording;
pub mod recording_frame;
pub mod scenario;

//! The simulation: one step in the order of the paper's Fig. 2, told in [`step`].

pub mod hms;
pub mod mcn;
pub mod params;
pub mod plan;
pub mod recording;
pub mod recording_chunk;
pub mod recording_error;
pub mod recording_frame;
pub mod recording_packing;
pub mod scenario;

//! The simulation: one step in the order of the paper's Fig. 2, told in [`step`].

pub mod plan;
pub mod recording_frame;

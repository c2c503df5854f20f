//! Plots of a motion database: velocity sets, parameters, coverage, poses, gait events.
//!
//! Read `all_plots`, which draws them all, then any other.

pub mod all_plots;
pub mod contact_sheet;
pub mod coverage;
pub mod gait_events;
pub mod parameter_space;
pub mod pose_distances;
pub(crate) mod stick_figure;
pub mod velocity_space;

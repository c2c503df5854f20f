//! Plots of a motion database: velocity sets, parameters, coverage, poses, gait events.
//!
//! Read `all_plots`, which draws them all, then any other.

pub(crate) mod all_plots;
pub(crate) mod contact_sheet;
pub(crate) mod coverage;
pub(crate) mod gait_events;
pub(crate) mod parameter_space;
pub(crate) mod pose_distances;
pub(crate) mod stick_figure;
pub(crate) mod velocity_space;

pub use all_plots::write_database_plots;
pub use contact_sheet::contact_sheet;
pub use coverage::coverage_slices;
pub use gait_events::gait_events;
pub use parameter_space::parameter_space;
pub use pose_distances::{pose_distances, pose_distances_between};
pub use velocity_space::velocity_space;

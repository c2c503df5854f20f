//! Plots of a motion database: velocity sets, parameters, coverage, poses, gait events.
//!
//! Enters: a valid database. Leaves: opaque pictures; [`write_database_plots`] writes all of them as PNG files.
//!
//! Read `all_plots`, then any other: `velocity_space`; `parameter_space` and `coverage`, which share
//! `parameter_planes`; `contact_sheet` and `transition_sheet`, which draw `body_views` and `stick_figure`s; `gait_events`; `pose_distances`.

pub(crate) mod all_plots;
pub(crate) mod body_views;
pub(crate) mod contact_sheet;
pub(crate) mod coverage;
pub(crate) mod gait_events;
pub(crate) mod parameter_planes;
pub(crate) mod parameter_space;
pub(crate) mod pose_distances;
pub(crate) mod stick_figure;
pub(crate) mod transition_sheet;
pub(crate) mod velocity_space;

pub use all_plots::{database_plot_paths, write_database_plots};
pub use contact_sheet::contact_sheet;
pub use coverage::coverage_slices;
pub use gait_events::gait_events;
pub use parameter_space::parameter_space;
pub use pose_distances::{pose_distances, pose_distances_between};
pub use transition_sheet::transition_sheet;
pub use velocity_space::velocity_space;

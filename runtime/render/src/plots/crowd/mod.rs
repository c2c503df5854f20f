//! Plots of crowds: paths, comparisons of planners, the fundamental diagram.

pub mod comparison;
pub mod fundamental_diagram;
pub mod side_by_side;
pub mod trajectories;

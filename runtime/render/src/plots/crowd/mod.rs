//! Plots of crowds: paths, comparisons of planners, the fundamental diagram.

pub(crate) mod comparison;
pub(crate) mod fundamental_diagram;
pub(crate) mod side_by_side;
pub(crate) mod trajectories;

pub use comparison::{Comparison, Measure, comparison};
pub use fundamental_diagram::{Diagram, diagram};
pub use side_by_side::{Way, side_by_side};
pub use trajectories::trajectories;

//! Plots of crowds: paths, comparisons of planners, the fundamental diagram, lines and areas that a
//! scenario measures.
//!
//! Enters: tracks of a recording, or measures of a bench. Leaves: an opaque picture.
//!
//! Read `trajectories`, then `side_by_side`, `comparison`, `fundamental_diagram` and `place_plots`.

pub(crate) mod comparison;
pub(crate) mod fundamental_diagram;
pub(crate) mod place_plots;
pub(crate) mod side_by_side;
pub(crate) mod trajectories;

pub use comparison::{ComparedMeasure, Comparison, comparison};
pub use fundamental_diagram::{FundamentalDiagram, fundamental_diagram};
pub use place_plots::{place_plot, place_plot_path, write_place_plots};
pub use side_by_side::{PathPanel, side_by_side};
pub use trajectories::trajectories;

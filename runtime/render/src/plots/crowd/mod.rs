//! Plots of crowds: paths, comparisons of planners, the fundamental diagram, lines and areas that a scenario measures,
//! the plan of a scene, strips of single agents.
//!
//! Enters: a recording, measures of a bench, or a scenario. Leaves: an opaque picture.
//!
//! Read `trajectories`, then `side_by_side`, `comparison`, `fundamental_diagram`, `place_plots`, `scene_plan` and
//! `agent_strip`.

pub(crate) mod agent_strip;
pub(crate) mod comparison;
pub(crate) mod fundamental_diagram;
pub(crate) mod place_plots;
pub(crate) mod scene_plan;
pub(crate) mod side_by_side;
pub(crate) mod trajectories;

pub use agent_strip::{StripOptions, agent_strip, strip_paths, write_agent_strips};
pub use comparison::{ComparedMeasure, Comparison, comparison};
pub use fundamental_diagram::{FundamentalDiagram, fundamental_diagram};
pub use place_plots::{place_plot, place_plot_path, write_place_plots};
pub use scene_plan::scene_plan;
pub use side_by_side::{PathPanel, side_by_side};
pub use trajectories::trajectories;

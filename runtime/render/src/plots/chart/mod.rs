//! Charts: the parts of a plot.
//!
//! Enters: values in the units of axes, and texts. Leaves: an opaque picture, a [`figure::PlotFigure`]. Positions on a
//! figure are in pixels, y down.
//!
//! Read `figure`, then what it draws with: `axis`, `mark` (shapes of points) and `label_positions` (labels that do not
//! overlap). `cell_grid` arranges the panels of a figure in a grid.

pub(crate) mod axis;
pub(crate) mod cell_grid;
pub(crate) mod figure;
pub(crate) mod label_positions;
pub(crate) mod mark;

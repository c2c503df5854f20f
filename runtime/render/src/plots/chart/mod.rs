//! Charts: a `figure` with panels, their `axis`, `mark`s of points, positions of labels that do not overlap, and the grid of
//! cells of a sheet with many panels. Positions on a figure in pixels, y down.

pub(crate) mod axis;
pub(crate) mod cell_grid;
pub(crate) mod figure;
pub(crate) mod label_positions;
pub(crate) mod mark;

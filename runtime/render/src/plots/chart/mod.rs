//! A chart: the plane of a `plot`, its `axis`, its `mark`s, and positions of labels that do not overlap.

pub mod axis;
pub(crate) mod label_positions;
pub mod mark;
pub mod plot;

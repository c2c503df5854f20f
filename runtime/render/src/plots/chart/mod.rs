//! A chart: the plane of a `plot`, its `axis`, its `mark`s, and positions of labels that do not overlap.

pub(crate) mod axis;
pub(crate) mod label_positions;
pub(crate) mod mark;
pub(crate) mod plot;

pub use axis::Axis;
pub use mark::Mark;
pub use plot::{Figure, Line, Panel};

//! The blend space: simplices over the parameters of the examples (`FbCrowd` §5, App. 10).
//!
//! Enters: (v_f, ω_t, ω_s) of each example. Leaves: for a requested point, shares of at most four examples.
//!
//! Read `space`, then `triangulation` (how simplices are found), `locator` (which one holds a point), then the proof that
//! they tile the hull: `tiling` on the `lattice`, with `simplex`, `surface` and `grid`.

pub(crate) mod grid;
pub(crate) mod lattice;
pub(crate) mod locator;
pub(crate) mod simplex;
pub(crate) mod space;
pub(crate) mod surface;
pub(crate) mod tiling;
pub mod triangulation;

pub use lattice::{Lattice, LatticePoint};
pub use locator::Locator;
pub use space::{BlendSpace, MAX_CORNERS, Shares};

//! The blend space: simplices over the parameters of the examples (`FbCrowd` §5, App. 10).
//!
//! Enters: (v_f, ω_t, ω_s) of each example. Leaves: for a requested point, the shares of at most four examples.
//!
//! Read `space` first. Offline: `triangulation` builds the simplices on the exact `lattice`, `tiling` checks that they
//! fill the hull. At run time: `locator` finds the shares of a point, with `simplex`, `simplex_grid` (inside the hull)
//! and `hull_surface` (outside).
//!
//! Build a blend space over three examples, and query a point between them:
//!
//! ```
//! use motiondb::blend_space::triangulation;
//! use motiondb::{Locator, Parameters};
//!
//! let example = |speed_mps, turn_rate_rad_s| Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
//! let examples = [example(0.0, 0.0), example(1.2, 0.0), example(0.8, 1.0)]; // a stand, a walk, a left turn
//! let space = triangulation::build(&examples);
//! assert_eq!((space.dimension, space.covered_share), (2, 1.0));
//!
//! let locator = Locator::new(&space, &examples);
//! let between = locator.locate(example(0.8, 0.5)); // inside the triangle
//! let sum = (0..3).fold(0.0, |sum, corner| {
//!     sum + between.shares[corner] * examples[between.examples[corner] as usize].turn_rate_rad_s
//! });
//! assert!((sum - 0.5).abs() < 1e-6);
//!
//! let run = example(3.0, 0.0); // outside: the nearest point is the walk
//! assert!(locator.locate_inside(run).is_none());
//! assert!(locator.locate(run).shares.contains(&1.0));
//! ```

pub(crate) mod hull_surface;
pub(crate) mod lattice;
pub(crate) mod locator;
pub(crate) mod simplex;
pub(crate) mod simplex_grid;
pub(crate) mod space;
pub(crate) mod tiling;
pub mod triangulation;

pub use locator::Locator;
pub use space::{BlendSpace, MAX_CORNERS, Shares};

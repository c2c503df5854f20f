//! Options that hold for the whole set of clips.

use std::num::NonZeroUsize;

use motiondb::velocity_sets::velocity_hull::Construction;

/// Options of a compilation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Greatest number of recorded examples, mirrors not counted; no limit where `None`.
    pub max_examples: Option<NonZeroUsize>,
    /// How the velocity sets are built of the examples.
    pub velocity_hull: Construction,
}

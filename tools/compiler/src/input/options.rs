//! What a user requests of the whole set of clips.

use std::num::NonZeroUsize;

use motiondb::velocity_sets::velocity_hull::Construction;

/// Requests for a database as a whole; the default keeps every example.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Greatest number of recorded examples, mirrors not counted; `None` keeps all.
    pub max_examples: Option<NonZeroUsize>,
    /// Construction of the velocity sets: which examples bound which velocities.
    pub velocity_hull: Construction,
}

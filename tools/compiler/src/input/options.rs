//! What a user requests of the whole set of clips.

use std::num::NonZeroUsize;

use motiondb::velocity_sets::velocity_hull::Construction;

/// Requests for a database as a whole; the default has no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Greatest number of recorded examples, mirrors not counted; `None` keeps all.
    pub max_examples: Option<NonZeroUsize>,
    /// Cycles whose feet slide or are hardly planted give examples also where clean cycles reach them.
    pub keep_doubtful: bool,
    /// Construction of the velocity sets: which examples bound which velocities.
    pub velocity_hull: Construction,
}

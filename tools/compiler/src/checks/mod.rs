//! Checks: whether a clip can be true, and whether level ground carries the body.
//!
//! Enters: a `HumanClip`. Leaves: typed verdicts.

pub(crate) mod level_ground;
pub(crate) mod plausibility;

//! Checks: whether a clip can be true, and whether level ground carries the body.
//!
//! Enters: a `SourceClip` with roles and whole-clip parameters, or a `HumanBody`. Leaves: warnings, verdicts and reasons
//! of rejection, all typed.
//!
//! `plausibility` judges unit, up axis, gait and body; `level_ground` what else than feet moves the body.

pub(crate) mod level_ground;
pub(crate) mod plausibility;

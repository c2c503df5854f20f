//! Transitions: starts, stops, turns, steps and pivots, found in the clips and joined to the examples of the set.
//!
//! Enters: the clips on the target body ([`AnalyzedClip`](crate::cycle::analyzed_clip::AnalyzedClip)) with their
//! movements, and the cycles that became examples. Leaves:
//! [`JoinedAction`](crate::action::joined_action::JoinedAction)s by kind and name.
//!
//! Read `transitions` (the chapter's steps), then `joint_state` with `example_rows`, `root_path`, `recorded_transition`,
//! `selection`, `movements_without_idle`, `unused_corners`. Where transitions may lie in a clip, [`crate::gait`] finds.

pub(crate) mod example_rows;
pub(crate) mod joint_state;
pub(crate) mod movements_without_idle;
pub(crate) mod only_transitions;
pub(crate) mod recorded_transition;
pub(crate) mod root_path;
pub(crate) mod selection;
pub(crate) mod transitions;
pub(crate) mod unused_corners;

//! Duplicate detection: where several clips hold the same take, only the best copy gives examples.
//!
//! Enters: all clips and their steady cycles. Leaves: the same clips without the cycles that a better copy of the take
//! gives, with a diagnostic for each clip concerned.
//!
//! Read `duplicates` (the chapter's steps); then `signature` (a clip without performer, skeleton, position and
//! heading), `correlation` (how unlike two signatures are at a lag), `comparison` with `alignment` (whether two clips
//! are one take, and how one lies on the other), `groups` (clips of one take), `shared_windows` (which windows give
//! examples) and `frame_times` (which frame time is a human's).

pub(crate) mod alignment;
pub(crate) mod comparison;
pub(crate) mod comparison_log;
pub(crate) mod correlation;
pub(crate) mod duplicates;
pub(crate) mod frame_times;
pub(crate) mod groups;
pub(crate) mod shared_windows;
pub(crate) mod signature;

pub use alignment::Alignment;
pub use duplicates::{Pair, pairs};

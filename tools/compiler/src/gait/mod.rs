//! Gait: when the feet are on the ground, and in which parts of a clip the body steps steadily or stands.
//!
//! Enters: each clip twice: on the performer's body ([`HumanClip`](crate::retarget::HumanClip)) and on the target body
//! ([`GroundedClip`](crate::ground::GroundedClip)). Leaves: [`GaitWindow`]s of whole strides or of standing, and the
//! stances of both feet; or why a clip has none.
//!
//! Read `performer_gait` (the chapter's entry) and `windows` (its steps), then the steps one by one: `contacts`,
//! `foot_stance` with `contact_ends`, `stride` on a `body_track`, `steady_strides` with `stride_spread`,
//! `stride_alignment`, `standing`, `unsteady_strides`; then `pauses` and `movements`, where transitions may lie.

pub(crate) mod body_track;
pub(crate) mod contact_ends;
pub(crate) mod contacts;
pub(crate) mod foot_stance;
pub(crate) mod movements;
pub(crate) mod pauses;
pub(crate) mod performer_gait;
pub(crate) mod standing;
pub(crate) mod steady_strides;
pub(crate) mod stride;
pub(crate) mod stride_alignment;
pub(crate) mod stride_spread;
pub(crate) mod unsteady_strides;
pub(crate) mod windows;

pub use foot_stance::FootStance;
pub use performer_gait::{PerformerGait, own_clip};
pub use stride::{Landmark, Stride};
pub use windows::{GaitAnalysis, GaitWindow, WindowGait};

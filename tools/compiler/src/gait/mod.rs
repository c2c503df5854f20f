//! Gait: what the feet do.
//!
//! Enters: a `GroundedClip`. Leaves: steady windows of whole strides, and windows in which the body stands.
//!
//! Read `contacts`, then `gait_events`, `stride`, `steady_window`, `standing`, then `windows`, which uses them all;
//! `own_body` carries gait found on the performer's own body over, `stride_alignment` aligns phases.

pub(crate) mod contacts;
pub(crate) mod gait_events;
pub mod own_body;
pub(crate) mod standing;
pub(crate) mod steady_window;
pub(crate) mod stride;
pub(crate) mod stride_alignment;
pub(crate) mod windows;

pub use contacts::Contacts;
pub use gait_events::Stance;
pub use steady_window::{SteadyWindow, Steps};
pub use stride::{BodyTrack, Landmark, Stride};
pub use windows::{Gait, GaitAnalysis, Window};

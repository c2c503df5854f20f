//! Semi-procedural locomotion: one walk, deformed to any (v_f, ω_t, ω_s) (`FbCrowd` §5; Johansen 2009).
//!
//! Enters: the base walk m_sp and parameters. Leaves: a posture.
//!
//! Read `foot_path`, then `base_walk` and `landing`, then `deformation`.

pub(crate) mod base_walk;
pub(crate) mod deformation;
pub(crate) mod foot_path;
pub(crate) mod landing;

pub use base_walk::BaseWalk;
pub use deformation::Deformation;

//! Semi-procedural locomotion: one walk, deformed to any (v_f, ω_t, ω_s) (`FbCrowd` §5; Johansen 2009).
//!
//! Enters: the base walk m_sp and parameters. Leaves: a pose.
//!
//! Read `base_walk`, then `foot_path` and `landing`, then `deformation`.

pub mod base_walk;
pub mod deformation;
pub mod foot_path;
pub mod landing;

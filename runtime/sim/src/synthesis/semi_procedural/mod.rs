//! Semi-procedural locomotion: one walk, deformed to any (v_f, ω_t, ω_s) (`FbCrowd` §5; Johansen 2009).
//!
//! Enters: the base walk m_sp and parameters. Leaves: a pose.
//!
//! Read `base_walk`, then `foot_path` and `landing`, then `deformation`.

pub(crate) mod base_walk;
pub(crate) mod deformation;
pub(crate) mod foot_path;
pub(crate) mod landing;

pub use base_walk::SemiProcedural;
pub use deformation::{Deformation, Tempo};
pub use foot_path::Foothold;
pub use landing::Landing;

//! Reading: files become `SourceClip`s, global positions and orientations of named joints over time.
//!
//! Enters: bytes of a BVH or glTF file. Leaves: its clips, in the file's own units and axes.
//!
//! Read `source_clip`, then `bvh`, then `gltf`; `decimal` reads numbers, `catch_panic` guards the parsers of others.

pub mod bvh;
pub(crate) mod catch_panic;
pub(crate) mod decimal;
pub mod gltf;
pub(crate) mod source_clip;

pub use source_clip::{SourceClip, SourceJoint};

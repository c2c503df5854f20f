//! Reading: files become [`SourceClip`]s, global positions and orientations of all joints over time.
//!
//! Enters: bytes of a BVH or glTF file. Leaves: its clips, in the file's own unit and axes.
//!
//! Read `axis`, `source_clip` and `source_motion`, then [`bvh`], then [`gltf`]. `decimal` reads numbers, `malformed` makes
//! the errors for broken files, `foreign_format` names files of other formats, `catch_panic` guards other crates'
//! parsers.

pub(crate) mod axis;
pub mod bvh;
pub mod catch_panic;
pub(crate) mod decimal;
pub(crate) mod foreign_format;
pub mod gltf;
pub(crate) mod malformed;
pub(crate) mod source_clip;
pub(crate) mod source_motion;

pub use axis::Axis;
pub use foreign_format::ForeignFormat;
pub use source_clip::{SourceClip, SourceJoint};

//! The files of the bundled clips: BVH, GLB with a skinned body, README.
//!
//! Enters: [`ClipPose`](crate::body::ClipPose)s (x forward, y left, z up, metres), and the catalogue for the README.
//! Leaves: the bytes of each file.
//!
//! Read `bvh_writer`; `body_mesh`, `glb_buffer`, `glb_writer`; `readme`.

pub(crate) mod body_mesh;
pub(crate) mod bvh_writer;
pub(crate) mod glb_buffer;
pub(crate) mod glb_writer;
pub(crate) mod readme;

pub(crate) use bvh_writer::bvh_bytes;
pub(crate) use glb_writer::glb_bytes;
pub(crate) use readme::readme_bytes;

//! glTF 2.0 → [`SourceClip`](crate::read::SourceClip)s, one for each body that an animation moves, sampled at 30 Hz.
//!
//! # What the crate `gltf` does
//! `gltf` 1.4 splits a GLB file into its JSON and its binary chunk ([`gltf::Glb`]). Its part `gltf-json` parses the
//! JSON into typed structs ([`gltf::json::Root`]) and validates them: required properties, indices, enumerations.
//!
//! # What is read here
//! - `chunks` reads a file's JSON and finds its binary chunk; it rejects other formats and documents without measure.
//! - `document_json` rejects other versions, drops channels without a node, and catches the crate's panics.
//! - `buffers` reads the binary chunk, data URIs and files beside the document, never more bytes than the document
//!   states and nothing outside the document's folder. The crate's own importer is not built in.
//! - `accessor` reads plain, sparse and normalised numbers by index. The crate's wrappers search each accessor from the
//!   first one on and panic on an index out of range.
//! - `node_tree` orders nodes and finds bodies, `key_track` interpolates keys (glTF 2.0 specification, Appendix C),
//!   `clip_plan` names and limits clips, `sampling` computes poses. The crate has none of these.
//!
//! # Poses
//! All nodes of a body count as joints, skinned or not. Scales above joints (Mixamo 0.01, Blender 100) multiply their
//! positions; a joint's orientation is the rotation in its global matrix. glTF defines metres and Y up; the compiler
//! measures the up axis all the same.
//!
//! Clips are read one by one from the open file, so a file of thousands of animations is never held as clips at once.
//!
//! Read `chunks`, `document_json`, `document`, `node_tree`, `node_channel`, `accessor`, `key_track`, `clip_plan`, `sampling`, and
//! last `gltf_file`, which is the entry. `camera` reads the file's cameras.

pub(crate) mod accessor;
pub(crate) mod buffers;
mod camera;
pub(crate) mod chunks;
mod clip_plan;
pub(crate) mod document;
pub(crate) mod document_json;
mod gltf_file;
mod key_track;
mod node_channel;
pub(crate) mod node_transform;
pub(crate) mod node_tree;
mod sampling;

pub use buffers::Outside;
pub use camera::{GltfCamera, GltfCameraKey, GltfLens, read_cameras};
pub use gltf_file::{GltfFile, read};

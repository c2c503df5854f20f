//! Motion clips in, motion database out: one file per stage, in `compile.rs` one line per stage.
//!
//! import ([`bvh`], [`gltf`]) → [`source_clip::SourceClip`] → [`skeleton_map`] → [`human_clip::HumanClip`]

pub mod human_clip;

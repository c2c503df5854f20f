//! What a lens sees of a scene: which part lies nearest at each sample of each pixel.
//!
//! Enters: rounded cones and triangles in the world, and a [`Lens`]. Leaves: [`TileSamples`], tile by tile: depth and
//! part of every sample, and their sum for a pixel, the [`Fragment`]s. Shading and passes (depth, normals, ids,
//! coverage, motion) are computed from them and never touch visibility.
//!
//! World: metres, z up. Camera space: x right, y down, z forward, metres; depth is z.
//!
//! Read `lens`, then `scene_parts` (what is drawn) with `part`, `owner`, `texture` and `closed_surface`, `sample_pattern`, `rounded_cone` and `triangle` (the kernels),
//! `screen_bounds`, `screen_meshes`, `tile_samples` (one tile), and `tiles` (all of them, in parallel).

pub(crate) mod closed_surface;
pub(crate) mod lens;
pub(crate) mod owner;
pub(crate) mod part;
pub(crate) mod rounded_cone;
pub(crate) mod sample_pattern;
pub(crate) mod scene_parts;
pub(crate) mod screen_bounds;
pub(crate) mod screen_meshes;
pub(crate) mod texture;
pub(crate) mod tile_samples;
pub(crate) mod tiles;
pub(crate) mod triangle;

pub(crate) use closed_surface::closed_triangles;
pub use lens::Lens;
pub use owner::{Owner, Owners};
pub use part::PartId;
pub use sample_pattern::SamplePattern;
pub(crate) use scene_parts::MeshSize;
pub use scene_parts::{Cone, Meshes, Paint, SceneParts};
pub use texture::Texture;
pub use tile_samples::{Fragment, TileSamples};
pub(crate) use tiles::{PreparedTiles, TILE_PX, for_each_tile};

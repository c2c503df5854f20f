//! Light: from what a lens sees to colours.
//!
//! Enters: the samples of a tile, the parts of the scene, and the ground. Leaves: scene-linear Rec. 709 pixels, and by the
//! tone curve sRGB. One shade is computed for each pixel and distinct part.
//!
//! Read `light` (sun and sky), `ground_plan` (what is painted on the ground) and `grid_lines`, `shadow_map`, `occlusion`
//! (where little sky is seen), `surface` (a point of a body or wall), `shader` (all of it), then `linear_picture` and `tone`.

pub(crate) mod grid_lines;
pub(crate) mod ground_plan;
pub(crate) mod light;
pub(crate) mod linear_picture;
pub(crate) mod occlusion;
pub(crate) mod shader;
pub(crate) mod shadow_map;
pub(crate) mod surface;
pub(crate) mod tone;

pub use linear_picture::LinearPicture;
pub use occlusion::Occlusion;

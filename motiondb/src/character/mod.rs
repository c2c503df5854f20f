//! Characters: a mesh of the user's own on a skeleton of its own, worn by the bodies of a crowd.
//!
//! Enters: a [`Character`] that `tools/compiler` made of a GLB or VRM file, and the pose of a canonical body. Leaves:
//! plain lists of world positions and normals, one for each vertex, which a renderer draws as triangles.
//!
//! ```
//! use motiondb::character::{Character, CharacterFit, JointTransform};
//! use motiondb::{Joints, Root, Skeleton};
//!
//! /// Positions (m) and normals of a character in a pose; world axes.
//! fn posed(character: &Character, skeleton: &Skeleton, joints: &Joints, root: &Root) -> [Vec<glam::Vec3>; 2] {
//!     // Once for each character and skeleton.
//!     let fit = CharacterFit::new(character, skeleton);
//!     // Once for each body and frame; the lists can be used again.
//!     let (mut transforms, [mut positions_m, mut normals]) = (Vec::<JointTransform>::new(), [Vec::new(), Vec::new()]);
//!     fit.pose(skeleton, joints, root.frame(), &mut transforms);
//!     // Fingers, toes and twist bones, where their rotations are known; here the fingers are at rest.
//!     fit.pose_extra(|extra_joint| fit.resting(extra_joint), &mut transforms);
//!     character.mesh.skin(&transforms, &mut positions_m, &mut normals);
//!     [positions_m, normals]
//! }
//! ```
//!
//! Bind space: the character as its mesh was bound to its joints, in the body's axes (x forward, y left, z up), in the
//! metres of its file; the origin lies on the ground under the pelvis.
//!
//! Read `model` (the noun), `texture` and `check` (its invariants), `character_file` (`.fbchar`), `fit` (what a character and a
//! skeleton give once) with `sole_outline` and `trunk_room`, `posing` with `extra_posing`, `skinning` with `dye`, and last `choice` (which
//! agent wears which character).

mod character_file;
mod check;
mod choice;
mod dye;
mod extra_posing;
mod fit;
mod model;
mod posing;
mod skinning;
mod sole_outline;
mod texture;
mod trunk_room;

pub use character_file::{EXTRA_VERSION, MAGIC, VERSION, from_bytes, load, to_bytes, write};
pub use check::{JOINTS_MAX, TRIANGLES_MAX, VERTICES_MAX, first_fault};
pub use choice::{chosen, hue_turn};
pub use dye::Dye;
pub use fit::{CharacterFit, HEIGHT_TOLERANCE, SCALE_TOLERANCE};
pub use model::{Character, CharacterExtra, CharacterFoot, CharacterJoint, CharacterMesh, Material, WEIGHT_COUNT};
pub use posing::JointTransform;
pub use texture::{CharacterTexture, CutOut, TEXTURE_PIXELS_MAX, TEXTURE_SIDE_MAX, Wrap, linear_values};

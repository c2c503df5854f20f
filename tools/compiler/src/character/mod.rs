//! Characters: a GLB, glTF or VRM file of one skinned figure → a [`Character`](motiondb::character::Character).
//!
//! # Steps
//! 1. the document with its buffers; VRM's bone table (`extensions`)
//! 2. every node where the meshes were bound (`bind_pose`)
//! 3. the role of each node (`joint_roles`), the body's axes (`body_axes`)
//! 4. the meshes that are drawn (`mesh_instances`) and worn (`worn_meshes`), each primitive in bind space (`primitive`), colours from textures
//!    (`texture`), all as one mesh (`body_mesh`)
//! 5. soles, heights and girths (`sizes`)
//! 6. fingers, toes and twist bones (`extra_bones`)
//! 7. the joints that are needed, in metres, with the soles on z = 0
//!
//! Read `compile_character`, which has a line for each step, and then the files in that order; `reason` has all
//! rejections and notes.

mod bind_pose;
mod body_axes;
mod body_mesh;
mod compile_character;
mod extensions;
mod extra_bones;
mod joint_roles;
mod mesh_instances;
mod primitive;
mod reason;
mod sizes;
mod texture;
mod worn_meshes;

pub use compile_character::{
    CompiledCharacter, FileContent, compile_character, compile_character_bytes, file_content, is_character_file,
};
pub use joint_roles::RolesFrom;
pub use reason::{CharacterNote, CharacterReason, CharacterRejection};

//! The picture of a character: its bind pose and a stride, with the joints that have a role.
//!
//! Enters: a character, and a pose of a crowd's body. Leaves: an opaque picture.
//!
//! Read `stride` (the pose), `character_sheet` (the picture), then `joint_names` (what is written on it).

mod character_sheet;
mod joint_names;
mod stride;

pub use character_sheet::character_sheet;
pub use stride::Stride;

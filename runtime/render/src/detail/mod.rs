//! Levels of detail of characters: meshes of fewer triangles, for bodies that are small in the picture.
//!
//! Enters: a [`CharacterFit`](motiondb::character::CharacterFit). Leaves: [`Levels`], its mesh reduced step by step, each
//! with the distance by which its surface deviates. They are made once, when a sequence begins, and depend on the
//! character and the skeleton alone.
//!
//! Edges collapse onto one of their ends (Garland and Heckbert 1997), so each vertex that is left is one of the
//! character's own, with its weights, normal and texture coordinates. The error of a collapse is the greatest over some
//! poses (Mohr and Gleicher 2003), so that knees and elbows bend as before; colours and texture coordinates count as
//! surfaces over the mesh (Hoppe 1999), and vertices move neither off borders nor over seams.
//!
//! Read `quadric` (the error), `example_poses`, `surface` (points, wedges and triangles of a mesh), `reduction` (collapses),
//! and `levels`, which also find the closed surfaces of each mesh.

mod example_poses;
mod levels;
mod quadric;
mod reduction;
mod surface;

pub(crate) use levels::{Level, Levels};

//! Pixels: shapes, colours, text, and files of pictures.
//!
//! Read `body` and `tapered_capsule`, which draw people, then `palette` and `text`, then `png_frame` and
//! `exr_frame`.

pub mod body;
pub mod exr_frame;
pub mod palette;
pub mod png_frame;
pub mod tapered_capsule;
pub mod text;

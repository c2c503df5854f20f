//! Pixels: shapes, colours, text, and files of pictures.
//!
//! Read `body` and `tapered_capsule`, which draw people, then `palette` and `text`, then `png_frame` and
//! `exr_frame`.

pub(crate) mod body;
pub(crate) mod exr_frame;
pub(crate) mod palette;
pub mod png_frame;
pub(crate) mod tapered_capsule;
pub(crate) mod text;

pub use body::{Detail, Part};
pub use palette::{Look, Rgb, decode_srgb};
pub use tapered_capsule::{Canvas, Cone};
pub use text::{Anchor, Typeface};
